//! Options of meshes: keywords as a value of the library, which checks them.

use std::collections::BTreeMap;

use neurotess::recipe::{MeshOptions, NamedOptions, OptionValue, OptionsError, Spelling};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyMapping, PyString};

use crate::errors;

/// The options of these keywords; what is None has its default.
///
/// # Errors
/// `ValueError` for what is wrong with an option, `TypeError` for what is no value at all.
pub(crate) fn mesh_options(keywords: &Bound<'_, PyDict>) -> PyResult<MeshOptions> {
    let py = keywords.py();
    let wrong = |error: OptionsError| errors::option(py, &error.told(Spelling::Keyword));
    let mut named = NamedOptions::default();
    for (keyword, value) in keywords {
        if let Some(value) = option_value(&value)? {
            let keyword: String = keyword.extract()?;
            named.set(&keyword, &value).map_err(wrong)?;
        }
    }
    named.options().map_err(wrong)
}

/// A value of Python or NumPy; none if it is None.
fn option_value(value: &Bound<'_, PyAny>) -> PyResult<Option<OptionValue>> {
    if value.is_none() {
        return Ok(None);
    }
    if let Ok(switch) = value.cast::<PyBool>() {
        return Ok(Some(OptionValue::Switch(switch.is_true())));
    }
    if let Ok(text) = value.cast::<PyString>() {
        return Ok(Some(OptionValue::Text(text.extract()?)));
    }
    if let Ok(whole) = value.extract() {
        return Ok(Some(OptionValue::Whole(whole)));
    }
    if let Ok(number) = value.extract() {
        return Ok(Some(OptionValue::Number(number)));
    }
    if let Ok(mapping) = value.cast::<PyMapping>() {
        let mut entries = BTreeMap::new();
        for item in mapping.items()?.try_iter()? {
            let (key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>) = item?.extract()?;
            entries.insert(key.str()?.extract()?, some(&value)?);
        }
        return Ok(Some(OptionValue::Map(entries)));
    }
    let values = value.try_iter()?;
    let values: PyResult<_> = values.map(|value| some(&value?)).collect();
    values.map(|values| Some(OptionValue::List(values)))
}

fn some(value: &Bound<'_, PyAny>) -> PyResult<OptionValue> {
    option_value(value)?.ok_or_else(|| PyTypeError::new_err("None is no value among others"))
}
