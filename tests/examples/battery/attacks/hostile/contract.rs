//! The routes of the server, as `api/openapi.json` has them: a new route is attacked by itself.

use serde_json::Value;

use crate::attack::Failure;

/// The document, and its routes.
pub struct Contract {
    document: Value,
    /// All routes.
    pub routes: Vec<Route>,
}

/// One method of one path.
#[derive(Debug, Clone)]
pub struct Route {
    /// Its method.
    pub method: String,
    /// Its path, with names in braces.
    pub path: String,
    /// Name, place and schema of its parameters.
    pub parameters: Vec<Parameter>,
    /// Media type and schema of its bodies.
    pub bodies: Vec<(String, Value)>,
}

/// A parameter.
#[derive(Debug, Clone)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// `path`, `query` or `header`.
    pub place: String,
    /// Its schema.
    pub schema: Value,
}

impl Contract {
    /// The one of this tree.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn read() -> Result<Self, Failure> {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../api/openapi.json");
        let document: Value = serde_json::from_slice(&std::fs::read(path)?)?;
        let paths = document["paths"].as_object().ok_or("a document without paths")?;
        let of = |(path, methods): (&String, &Value)| -> Vec<Route> {
            let methods = methods.as_object().into_iter().flatten();
            methods.map(|(method, operation)| route(path, method, operation)).collect()
        };
        let routes = paths.iter().flat_map(of).collect();
        Ok(Self { document, routes })
    }

    /// A schema, or what it refers to.
    pub fn resolve<'a>(&'a self, schema: &'a Value) -> &'a Value {
        match schema["$ref"].as_str().and_then(|place| place.strip_prefix('#')) {
            Some(place) => self.document.pointer(place).unwrap_or(&Value::Null),
            None => schema,
        }
    }
}

fn route(path: &str, method: &str, operation: &Value) -> Route {
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let parameters = operation["parameters"].as_array().into_iter().flatten();
    let parameters = parameters
        .map(|one| Parameter {
            name: text(&one["name"]),
            place: text(&one["in"]),
            schema: one["schema"].clone(),
        })
        .collect();
    let bodies = operation["requestBody"]["content"].as_object().into_iter().flatten();
    let bodies = bodies.map(|(media, body)| (media.clone(), body["schema"].clone())).collect();
    Route { method: method.to_uppercase(), path: path.to_owned(), parameters, bodies }
}
