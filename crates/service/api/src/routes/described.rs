//! Types of other crates in the OpenAPI document, by the JSON Schemas that describe them elsewhere
//! as well.

use schemars::generate::SchemaSettings;
use serde_json::{Map, Value};
use sistership_diagnosis as diagnose;
use sistership_fleet::bulk::BulkSettings;
use sistership_identification::refine;
use sistership_learned::BranchSettings;
use sistership_model::Model;
use sistership_model::vessel::VesselFile;
use utoipa::openapi::RefOr;
use utoipa::openapi::schema::Schema;

use crate::web::field::any_object;

/// Body of a vessel; its schema is added to the document separately.
pub(super) struct VesselBodySchema;

impl utoipa::PartialSchema for VesselBodySchema {
    fn schema() -> RefOr<Schema> {
        any_object()
    }
}

impl utoipa::ToSchema for VesselBodySchema {
    fn name() -> std::borrow::Cow<'static, str> {
        <VesselFile as schemars::JsonSchema>::schema_name()
    }
}

/// Returns the schemas of all request types of other crates, by name.
pub(super) fn request_schemas() -> Map<String, Value> {
    let settings = SchemaSettings::draft2020_12().for_deserialize();
    let mut generator = settings
        .with(|settings| settings.definitions_path = "/components/schemas".into())
        .into_generator();
    generator.subschema_for::<refine::RefinementSettings>();
    generator.subschema_for::<diagnose::Settings>();
    generator.subschema_for::<BulkSettings>();
    generator.subschema_for::<BranchSettings>();
    generator.subschema_for::<Model>();
    generator.subschema_for::<VesselFile>();
    generator.take_definitions(true)
}

/// Adds the schemas of other crates to the document.
pub(super) fn add_request_schemas(document: &mut Value) {
    if let Some(known) = document["components"]["schemas"].as_object_mut() {
        known.extend(request_schemas());
    }
}
