//! `[[event]]` tables of a scene file: when, and what is done.

use serde::Deserialize as _;
use toml::{Table, Value};

use crate::event::{Action, SceneEvent, When};

/// Reads the table of an event: `step` or `time`, and one action by its name.
pub(super) fn read(mut table: Table) -> Result<SceneEvent, String> {
    let at = match (table.remove("step"), table.remove("time")) {
        (Some(step), None) => match step.as_integer().and_then(|step| u64::try_from(step).ok()) {
            Some(step) => When::Step(step),
            None => return Err(format!("step must be a whole number from 0 up, got {}", shown(&step))),
        },
        (None, Some(time)) => match time.as_float().or(time.as_integer().map(|secs| secs as f64)) {
            Some(secs) if secs >= 0.0 && secs.is_finite() => When::Time(secs),
            _ => return Err(format!("time must be finite and at least 0, got {}", shown(&time))),
        },
        (None, None) => return Err("give the step or the time it happens at".to_owned()),
        (Some(_), Some(_)) => return Err("give its step or its time, not both".to_owned()),
    };
    let mut actions = table.into_iter();
    let Some((name, given)) = actions.next() else {
        return Err("give what is done: insert, remove, teleport, velocity, …".to_owned());
    };
    if let Some((other, _)) = actions.next() {
        return Err(format!("one thing is done by an event, got {name} and {other}; give each its own"));
    }
    let given = by_slot(&name, given)?;
    let action = if name == "let_go" && given == Value::Boolean(true) {
        Ok(Action::LetGo)
    } else {
        Action::deserialize(Value::Table(Table::from_iter([(name.clone(), given)])))
    };
    let why = |why: toml::de::Error| format!("{name}: {}", why.to_string().trim_end());
    Ok(SceneEvent { at, action: action.map_err(why)? })
}

/// A value as it is written, or what it is.
fn shown(value: &Value) -> String {
    match value {
        Value::Integer(number) => number.to_string(),
        Value::Float(number) => format!("{number:?}"),
        Value::String(text) => format!("{text:?}"),
        Value::Boolean(truth) => truth.to_string(),
        other => format!("a value of type {}", other.type_str()),
    }
}

/// A scene file names bodies by their numbers, an action by their slots: the k-th is in slot k + 1.
fn by_slot(name: &str, given: Value) -> Result<Value, String> {
    let Value::Table(mut fields) = given else { return Ok(given) };
    if name != "insert" {
        if fields.contains_key("slot") {
            return Err(format!("{name}: a body is named by `body`, its number in the scene from 0"));
        }
        if let Some(body) = fields.remove("body") {
            let slot = body.as_integer().and_then(|body| u32::try_from(body).ok()?.checked_add(1));
            let slot =
                slot.ok_or(format!("{name}: body must be a whole number from 0 up, got {}", shown(&body)))?;
            fields.insert("slot".to_owned(), Value::Integer(slot.into()));
        } else if !matches!(name, "motor" | "set_motor" | "choose" | "field" | "fields") {
            return Err(format!("{name}: name the body by `body`, its number in the scene from 0"));
        }
    }
    Ok(Value::Table(fields))
}
