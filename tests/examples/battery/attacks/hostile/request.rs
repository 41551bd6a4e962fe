//! Whole requests: a route, its parameters, its headers, a body, and what is wrong with them.

use std::net::SocketAddr;

use rand::RngExt as _;
use serde_json::Value;

use super::bodies::BOUNDARY;
use super::contract::{Parameter, Route};
use super::grammar::Grammar;
use super::raw::Raw;
use crate::client::encoded;

const MEDIA: &[&str] = &[
    "application/json",
    "application/yaml",
    "text/csv",
    "multipart/form-data",
    "text/html",
    "*/*",
    "",
];

impl Grammar {
    /// The next request.
    pub fn request(&mut self, address: SocketAddr) -> Raw {
        let place = self.rng.random_range(0..self.contract.routes.len());
        let route = self.contract.routes[place].clone();
        let method = match self.chance(0.03) {
            true => self.pick(&["PATCH", "HEAD", "OPTIONS", "DELETE", "TRACE", "QUERY"]).to_owned(),
            false => route.method.clone(),
        };
        let target = self.target(&route);
        let (media, body) = self.media_and_body(&route);
        let raw = Raw::new(&method, &target, address, &media, body);
        let raw = self.headers(raw, &route.parameters);
        self.broken(raw)
    }

    fn media_and_body(&mut self, route: &Route) -> (String, Vec<u8>) {
        if route.bodies.is_empty() {
            return if self.chance(0.05) {
                ("application/json".to_owned(), self.value().to_string().into_bytes())
            } else {
                Default::default()
            };
        }
        let (media, schema) = route.bodies[self.rng.random_range(0..route.bodies.len())].clone();
        let body = self.body(&media, &schema);
        let media = if self.chance(0.05) { self.pick(MEDIA).to_owned() } else { media };
        match media.as_str() {
            "multipart/form-data" => (format!("{media}; boundary={BOUNDARY}"), body),
            _ => (media, body),
        }
    }

    /// The path with its parameters.
    fn target(&mut self, route: &Route) -> String {
        let mut path = route.path.clone();
        let mut query = Vec::new();
        for parameter in &route.parameters {
            let value = self.parameter(parameter);
            match parameter.place.as_str() {
                "path" => path = path.replace(&format!("{{{}}}", parameter.name), &encoded(&value)),
                "query" if self.chance(0.6) => {
                    query.push(format!("{}={}", parameter.name, encoded(&value)))
                }
                _ => {}
            }
        }
        if self.chance(0.05) {
            query.push(encoded(&self.text()));
        }
        path.truncate(8000);
        if query.is_empty() { path } else { format!("{path}?{}", query.join("&")) }
    }

    /// A parameter that follows its schema, or any text.
    fn parameter(&mut self, parameter: &Parameter) -> String {
        let mut text = match self.chance(0.7) {
            true => match self.instance(&parameter.schema, 0) {
                Value::String(text) => text,
                other => other.to_string(),
            },
            false => self.text(),
        };
        let end = text.char_indices().nth(2000).map_or(text.len(), |(end, _)| end);
        text.truncate(end);
        text
    }

    fn headers(&mut self, mut raw: Raw, parameters: &[Parameter]) -> Raw {
        for parameter in parameters.iter().filter(|parameter| parameter.place == "header") {
            if self.chance(0.5) {
                let value = self.parameter(parameter).replace(['\r', '\n', '\0'], " ");
                raw = raw.header(&parameter.name, value);
            }
        }
        match self.rng.random_range(0..60) {
            0 => raw.header("x-long", "a".repeat(self.size(200_000))),
            1 => {
                (0..self.size(300)).fold(raw, |raw, number| raw.header(&format!("x-{number}"), "1"))
            }
            2 => raw.header("content-type", "text/csv"),
            3 => raw.header(
                "accept",
                self.pick(&["text/html", "application/yaml", "x/y;q=9", ",,,", "*"]),
            ),
            4 => raw.header("range", "bytes=5-1"),
            5 => raw.header("if-none-match", self.pick(&["*", "W/\"", "\"1\", \"2\"", "1"])),
            6 => raw.header("authorization", "Bearer x y z"),
            7 => raw.header("x-request-id", self.text().replace(['\r', '\n', '\0'], " ")),
            8 => raw.header("expect", "100-continue"),
            9 => raw.header("upgrade", "h2c"),
            10 => raw.header("content-encoding", "gzip"),
            _ => raw,
        }
    }

    /// Now and then a request that says less or more than it sends.
    fn broken(&mut self, mut raw: Raw) -> Raw {
        if !self.chance(0.03) {
            return raw;
        }
        raw.broken = true;
        match self.rng.random_range(0..5) {
            0 => {
                let length = raw.body.len() + 10;
                raw.header("content-length", length.to_string())
            }
            1 => raw.header("content-length", "-1"),
            2 => raw.header("content-length", "1").header("content-length", "2"),
            3 => raw.header("transfer-encoding", "chunked").header("content-length", "5"),
            _ => raw.header("transfer-encoding", "chunked"),
        }
    }
}
