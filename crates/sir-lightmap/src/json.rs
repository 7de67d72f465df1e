//! Access to the JSON of documents.

use serde_json::{Map, Value, json};

/// Returns a list of a document; an absent one is empty.
pub(crate) fn list<'a>(json: &'a Value, name: &str) -> &'a [Value] {
    json[name].as_array().map_or(&[], Vec::as_slice)
}

/// Returns the members of an object. Another value becomes an empty object.
pub(crate) fn object(value: &mut Value) -> &mut Map<String, Value> {
    if !value.is_object() {
        *value = json!({});
    }
    match value {
        Value::Object(members) => members,
        _ => unreachable!("it has just become an object"),
    }
}

/// Returns the elements of a list. Another value becomes an empty list.
pub(crate) fn array(value: &mut Value) -> &mut Vec<Value> {
    if !value.is_array() {
        *value = json!([]);
    }
    match value {
        Value::Array(elements) => elements,
        _ => unreachable!("it has just become a list"),
    }
}
