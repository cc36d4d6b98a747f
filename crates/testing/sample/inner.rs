//! A module of the sample.

#[neurotess_testing::test]
fn has_its_modules_name() {}
