//! SWC as programs write it in ways of their own: what is read is what they mean.

use neurotess_formats::{Read, ReadOptions, swc};
use neurotess_morphology::{Attachment, NeuriteKind};

fn read(text: &str) -> Read {
    swc::read_bytes(text.as_bytes(), "cell.swc", &ReadOptions::default()).expect("read")
}

fn codes(read: &Read) -> Vec<&'static str> {
    read.warnings.iter().map(|warning| warning.code).collect()
}

/// Length (µm) of all neurites, to the soma's surface or not: between their own points.
fn radii(read: &Read) -> Vec<f32> {
    read.morphology
        .points
        .iter()
        .map(|point| point.radius)
        .collect()
}

#[neurotess_testing::test]
fn parent_0_is_that_of_roots_where_no_sample_has_that_number() {
    let of_vaa3d = read("1 2 0 0 0 1 0\n2 2 0 9 0 1 1\n3 2 5 20 0 1 2\n");
    assert_eq!(of_vaa3d.morphology.sections.len(), 1);
    assert_eq!(of_vaa3d.morphology.points.len(), 3);
    assert!(codes(&of_vaa3d).contains(&"root_parent"));
    // Where there is one it is the parent.
    let from_0 = read("0 1 0 0 0 5 -1\n1 2 0 9 0 1 0\n2 2 0 19 0 1 1\n");
    assert!(codes(&from_0).is_empty(), "{:?}", from_0.warnings);
    let other = swc::read_bytes(b"1 2 0 0 0 1 7\n", "cell.swc", &ReadOptions::default());
    assert!(other.is_err(), "7 is nobody's number");
}

#[neurotess_testing::test]
fn types_of_forks_and_ends_are_those_of_their_parents() {
    let text = "1 0 0 0 0 1 -1\n2 3 0 10 0 1 1\n3 5 0 20 0 1 2\n4 3 10 30 0 1 3\n5 6 20 40 0 1 4\n\
                6 3 -10 30 0 1 3\n7 6 -20 40 0 1 6\n";
    let labeled = read(text);
    let sections = &labeled.morphology.sections;
    let kinds: Vec<i32> = sections.iter().map(|section| section.kind.0).collect();
    // The root of type 0, and three of dendrite: before the fork and after it.
    assert_eq!(kinds, [0, 3, 3, 3]);
    assert!(codes(&labeled).contains(&"fork_and_end_types"));
    // A type 6 that is not at an end is somebody's own type, and so are all.
    let own = read(&text.replace("4 3 10", "4 6 10"));
    assert!(!codes(&own).contains(&"fork_and_end_types"));
    assert!(
        own.morphology
            .sections
            .iter()
            .any(|s| s.kind == NeuriteKind(6))
    );
    // On the soma a fork is a neurite's.
    let on_soma = read("1 1 0 0 0 5 -1\n2 5 0 9 0 1 1\n3 2 3 19 0 1 2\n4 2 -3 19 0 1 2\n");
    assert_eq!(on_soma.morphology.sections[0].kind, NeuriteKind::UNDEFINED);
}

#[neurotess_testing::test]
fn a_soma_that_is_written_for_each_neurite_is_one() {
    let text = "1 1 0 0 0 8 -1\n2 3 10 0 0 1 1\n3 3 60 0 0 1 2\n4 1 0 0 0 8 -1\n5 2 -10 0 0 1 4\n\
                6 1 0.5 0 0 7 -1\n7 4 0 10 0 1 6\n";
    let cell = read(text);
    assert_eq!(cell.morphology.somata.len(), 1);
    assert_eq!(cell.morphology.somata[0].samples.len(), 1);
    let is_on_soma = |s: &&neurotess_morphology::Section| {
        matches!(s.attachment, Attachment::Soma { soma: 0, .. })
    };
    assert_eq!(
        cell.morphology.sections.iter().filter(is_on_soma).count(),
        3
    );
    let told = cell
        .warnings
        .iter()
        .find(|w| w.code == "coincident_somata")
        .expect("told");
    assert_eq!((told.count, told.line), (2, Some(4)));
    // Three points each.
    let points = |first: u32, child: &str| {
        format!(
            "{first} 1 0 0 0 8 -1\n{} 1 0 -8 0 8 {first}\n{} 1 0 8 0 8 {first}\n{} 3 {child} 1 {first}\n",
            first + 1,
            first + 2,
            first + 3
        )
    };
    let twice = read(&(points(1, "20 0 0") + &points(5, "-20 0 0")));
    assert_eq!(twice.morphology.somata.len(), 1);
    assert_eq!(twice.morphology.somata[0].samples.len(), 3);
    assert_eq!(twice.morphology.sections.len(), 2);
    // Cells side by side are several.
    let apart = read("1 1 0 0 0 8 -1\n2 3 10 0 0 1 1\n3 1 12 0 0 8 -1\n4 3 30 0 0 1 3\n");
    assert_eq!(apart.morphology.somata.len(), 2);
}

#[neurotess_testing::test]
fn what_begins_in_the_soma_hangs_on_it() {
    let cell = read(
        "1 1 0 0 0 5 -1\n2 3 0 0 0 1 -1\n3 3 0 20 0 1 2\n4 2 3 3 0 1 -1\n5 2 30 3 0 1 4\n6 2 50 0 0 1 -1\n7 2 60 0 0 1 6\n",
    );
    let free = |s: &&neurotess_morphology::Section| s.attachment == Attachment::Free;
    assert_eq!(cell.morphology.sections.iter().filter(free).count(), 1);
    let told = cell
        .warnings
        .iter()
        .find(|w| w.code == "root_in_soma")
        .expect("told");
    assert_eq!((told.count, told.line), (2, Some(2)));
}

#[neurotess_testing::test]
fn a_header_s_unit_is_read() {
    let rows = "1 1 10000 20000 15000 375 -1\n2 3 10400 20000 15000 20 1\n";
    let of_navis = format!("# Meta: {{\"id\": \"1\", \"units\": \"8 nanometer\"}}\n{rows}");
    let cell = read(&of_navis);
    assert!((cell.morphology.somata[0].radius - 3.0).abs() < 1e-5);
    assert!((radii(&cell)[0] - 0.16).abs() < 1e-6);
    assert_eq!(codes(&cell), ["units_in_header"]);
    // A copy is in micrometers and says so.
    let mut copy = Vec::new();
    swc::write(&cell.morphology, &mut copy).expect("memory takes it");
    let copy = String::from_utf8(copy).expect("text");
    assert!(copy.contains("\"units\": \"1 micrometer\""), "{copy}");
    let again = read(&copy);
    assert!(codes(&again).is_empty());
    assert_eq!(radii(&again), radii(&cell));
    // What cannot be applied is told.
    assert!(codes(&read(&format!("# units: nm\n{rows}"))).contains(&"unit_not_applied"));
    assert!(!codes(&read(&format!("# units: um\n{rows}"))).contains(&"unit_not_applied"));
    for none in [
        "\"units\": \"dimensionless\"",
        "\"units\": \"",
        "\"units\": 8",
    ] {
        assert!(!codes(&read(&format!("# Meta: {{{none}}}\n{rows}"))).contains(&"units_in_header"));
    }
}

/// Fault F15.
#[neurotess_testing::test]
fn a_cell_of_type_1_alone_is_neurites() {
    let text =
        "1 1 0 0 0 3 -1\n2 1 10 0 0 2 1\n3 1 60 20 0 1 2\n4 1 120 60 0 1 3\n5 1 120 -40 0 1 3\n";
    let of_regions = read(text);
    assert!(codes(&of_regions).contains(&"all_soma"));
    assert!(of_regions.morphology.somata.is_empty());
    assert_eq!(of_regions.morphology.points.len(), 5);
    let kinds = of_regions.morphology.sections.iter();
    assert!(
        kinds
            .clone()
            .all(|section| section.kind == NeuriteKind::UNDEFINED)
    );
    // A soma alone stays one: a point, a chain that is no longer than somata are, an outline.
    let chain = "1 1 0 0 0 6 -1\n2 1 8 0 0 7 1\n3 1 16 0 0 5 2\n4 1 24 9 0 3 3\n";
    let outline = "1 1 9 0 0 0 -1\n2 1 0 9 0 0 1\n3 1 -9 0 0 0 2\n4 1 0 -9 0 0 3\n5 1 6 -6 0 0 4\n";
    for text in ["1 1 0 0 0 5 -1\n", chain, outline] {
        let soma = read(text);
        assert_eq!(soma.morphology.somata.len(), 1, "{text}");
        assert!(!codes(&soma).contains(&"all_soma"), "{text}");
    }
}

/// Fault F16, also of a soma that is an outline.
#[neurotess_testing::test]
fn a_root_within_an_outline_hangs_on_its_soma() {
    let outline = "1 1 9 0 0 0 -1\n2 1 0 9 0 0 1\n3 1 -9 0 0 0 2\n4 1 0 -9 0 0 3\n5 1 6 -6 0 0 4\n";
    let attached = |start: &str| {
        let cell = read(&format!("{outline}6 3 {start} 1 -1\n7 3 0 60 0 1 6\n"));
        let attachment = cell.morphology.sections[0].attachment;
        (codes(&cell).contains(&"root_in_soma"), attachment)
    };
    let (told, attachment) = attached("0 7 0");
    assert!(told && attachment == Attachment::Soma { soma: 0, sample: 1 });
    assert_eq!(attached("0 20 0"), (false, Attachment::Free));
}

/// A ball of 6 µm about the origin with 24 places of a radius that says nothing, 6.5 µm from it, and a neurite.
fn with_places(parent: impl Fn(usize) -> i64, radius: f64) -> Read {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let mut text = String::from("1 1 0 0 0 6 -1\n");
    for i in 0..24_usize {
        let height = 1.0 - (i as f64 + 0.5) / 12.0;
        let (sin, cos) = (golden * i as f64).sin_cos();
        let width = 6.5 * (1.0 - height * height).sqrt();
        let [x, y, z] = [width * cos, width * sin, 6.5 * height];
        text += &format!("{} 1 {x} {y} {z} {radius} {}\n", i + 2, parent(i));
    }
    read(&(text + "26 3 7.5 0 0 0.8 1\n27 3 40 0 0 0.8 26\n"))
}

#[neurotess_testing::test]
fn places_on_a_soma_are_no_balls_whatever_they_hang_on() {
    let on_the_middle = |_| 1_i64;
    let in_a_row = |i| i as i64 + 1;
    let on_nothing = |_| -1_i64;
    let a_piece = |i| if i == 0 { -1 } else { i as i64 + 1 };
    for parent in [
        &on_the_middle as &dyn Fn(usize) -> i64,
        &in_a_row,
        &on_nothing,
        &a_piece,
    ] {
        for radius in [1.0, 0.0, 0.3] {
            let read = with_places(parent, radius);
            let [soma] = &read.morphology.somata[..] else {
                panic!("{} somata", read.morphology.somata.len());
            };
            assert_eq!(soma.kind.name(), "surface");
            assert!((soma.radius - 6.5).abs() < 1e-4, "{}", soma.radius);
            assert_eq!(soma.samples.len(), 25);
            assert!(codes(&read).contains(&"soma_marks"), "{:?}", read.warnings);
            // Written, it is the same soma.
            let mut bytes = Vec::new();
            swc::write(&read.morphology, &mut bytes).expect("written");
            let again =
                swc::read_bytes(&bytes, "again.swc", &ReadOptions::default()).expect("read");
            let again = &again.morphology.somata[0];
            assert_eq!((again.kind, again.radius), (soma.kind, soma.radius));
        }
    }
}

/// Somata of other cells keep theirs, however thin.
#[neurotess_testing::test]
fn somata_with_a_radius_of_their_own_stay_somata() {
    let text =
        "1 1 0 0 0 6 -1\n2 1 9 0 0 1.5 -1\n3 1 0 9 0 1 -1\n4 1 0 0 9 1.8 -1\n5 1 -9 0 0 1.7 -1\n";
    assert_eq!(read(text).morphology.somata.len(), 5);
}
