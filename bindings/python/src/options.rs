//! Options of meshes and pictures: keywords as values of the library, which checks them.

use std::collections::BTreeMap;

#[cfg(feature = "render")]
use neurotess::drawing::{DrawOptions, picture_of_png};
#[cfg(feature = "render")]
use neurotess::options::OptionError;
use neurotess::options::set_option;
use neurotess::recipe::{MeshOptions, NamedOptions, OptionValue, OptionsError, Spelling};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping, PyString};

use serde::Serialize;
use serde::de::DeserializeOwned;

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

/// What is drawn, of these keywords; what is None or False has its default.
///
/// # Errors
/// `ValueError` for what is wrong with an option, `TypeError` for what is no value at all.
#[cfg(feature = "render")]
pub(crate) fn draw_options(keywords: &Bound<'_, PyDict>) -> PyResult<DrawOptions> {
    let py = keywords.py();
    let mut options = DrawOptions::default();
    let mut base = None;
    if let Some(like) = keywords.get_item("like")?.filter(|like| !like.is_none()) {
        let file: std::path::PathBuf = like.extract()?;
        let recipe = picture_of_png(&file);
        let recipe = recipe.map_err(|e| errors::render(py, &e.to_string()))?;
        if let Some(warning) = recipe.warning(&file) {
            errors::warn(py, &warning)?;
        }
        base = Some(recipe.picture);
    }
    let mut given = Vec::new();
    for (keyword, value) in keywords {
        let Some(value) = option_value(&value)?.filter(|v| *v != OptionValue::Switch(false)) else {
            continue;
        };
        let keyword: String = keyword.extract()?;
        if keyword == "like" {
            continue;
        }
        let value = json_of(&value);
        set(&mut options, &keyword, &value).map_err(|e| errors::draw_option(py, &e))?;
        given.push(keyword);
    }
    if let Some(base) = base {
        options.picture = base.with(&options.picture, &given);
    }
    Ok(options)
}

#[cfg(feature = "render")]
fn set(
    options: &mut DrawOptions,
    keyword: &str,
    value: &serde_json::Value,
) -> Result<(), OptionError> {
    match keyword {
        "no_cache" => options.no_cache = true,
        "adapter" | "gpu_memory" => set_option(&mut options.device, keyword, value)?,
        _ => options.picture.set(keyword, value)?,
    }
    Ok(())
}

/// Sets options of a group by these keywords; what is None or False has its default.
///
/// # Errors
/// As [`draw_options`].
pub(crate) fn set_all<Group: Serialize + DeserializeOwned>(
    group: &mut Group,
    keywords: &Bound<'_, PyDict>,
) -> PyResult<()> {
    let py = keywords.py();
    for (keyword, value) in keywords {
        let Some(value) = option_value(&value)?.filter(|v| *v != OptionValue::Switch(false)) else {
            continue;
        };
        let keyword: String = keyword.extract()?;
        let set = set_option(group, &keyword, &json_of(&value));
        set.map_err(|e| errors::draw_option(py, &e))?;
    }
    Ok(())
}

/// A value as JSON; numbers that it has not as text, by which they are refused.
fn json_of(value: &OptionValue) -> serde_json::Value {
    use serde_json::Value;
    match value {
        OptionValue::Switch(value) => Value::Bool(*value),
        OptionValue::Whole(value) => Value::from(*value),
        OptionValue::Number(value) => serde_json::Number::from_f64(*value)
            .map_or(Value::String(value.to_string()), Value::Number),
        OptionValue::Text(value) => Value::String(value.clone()),
        OptionValue::List(values) => Value::Array(values.iter().map(json_of).collect()),
        OptionValue::Map(values) => {
            let entries = values
                .iter()
                .map(|(key, value)| (key.clone(), json_of(value)));
            Value::Object(entries.collect())
        }
    }
}

/// A value of Python or NumPy; none if it is None.
fn option_value(value: &Bound<'_, PyAny>) -> PyResult<Option<OptionValue>> {
    if value.is_none() {
        return Ok(None);
    }
    // Those of NumPy, too.
    if let Ok(switch) = value.extract::<bool>() {
        return Ok(Some(OptionValue::Switch(switch)));
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
