//! Location of the object store.

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use object_store::aws::AmazonS3Builder;
use object_store::prefix::PrefixStore;
use object_store::{BackoffConfig, ClientOptions, ObjectStore, RetryConfig};

use crate::error::{Result, StoreError};
use crate::objects::ObjectStorage;
use crate::objects_error::ObjectsError;

/// Default region: private servers have none.
const REGION: &str = "us-east-1";
/// Maximum time to establish a connection.
const CONNECT: Duration = Duration::from_secs(5);
/// Maximum time of a request; an upload may be large.
const REQUEST: Duration = Duration::from_secs(120);
/// Time for which a request is retried that the server could not answer.
const RETRY: Duration = Duration::from_secs(20);

/// Location of the object store.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ObjectsPlace {
    /// Below a folder.
    Folder(PathBuf),
    /// In a bucket.
    S3(S3Place),
}

/// A bucket of an S3-compatible store. Its credentials come from the environment
/// (`AWS_ACCESS_KEY_ID`, `AWS_SECRET_ACCESS_KEY`, `AWS_SESSION_TOKEN`), from the machine's or the
/// container's role, never from here.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct S3Place {
    /// The bucket.
    pub bucket: String,
    /// Prefix of the name of every object; empty for none.
    pub prefix: String,
    /// URL of the server; default: that of Amazon.
    pub endpoint: Option<String>,
    /// The region.
    pub region: Option<String>,
}

impl ObjectsPlace {
    /// Parses `s3://bucket/prefix`, with the endpoint and the region.
    ///
    /// # Errors
    /// Returns an error that states the expected form.
    pub fn parse_s3(url: &str, endpoint: Option<String>, region: Option<String>) -> Result<Self> {
        let wrong =
            || StoreError::invalid("objects_url", "write s3://BUCKET or s3://BUCKET/PREFIX");
        let rest = url.strip_prefix("s3://").ok_or_else(wrong)?;
        let (bucket, prefix) = rest.split_once('/').unwrap_or((rest, ""));
        let prefix = prefix.trim_matches('/');
        if bucket.is_empty()
            || bucket.contains(|c: char| !c.is_ascii_alphanumeric() && !"-._".contains(c))
            // An empty segment would be lost in the names of objects.
            || prefix.contains("//")
        {
            return Err(wrong());
        }
        if endpoint
            .as_ref()
            .is_some_and(|url| !url.starts_with("http://") && !url.starts_with("https://"))
        {
            return Err(StoreError::invalid(
                "objects_endpoint",
                "write http://HOST:PORT or https://HOST",
            ));
        }
        Ok(Self::S3(S3Place {
            bucket: bucket.to_owned(),
            prefix: prefix.to_owned(),
            endpoint,
            region,
        }))
    }

    /// Returns the folder of a local store; none for a bucket.
    pub fn folder_path(&self) -> Option<&Path> {
        match self {
            Self::Folder(folder) => Some(folder),
            Self::S3(_) => None,
        }
    }
}

impl fmt::Display for ObjectsPlace {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Folder(folder) => write!(out, "{}", folder.display()),
            Self::S3(S3Place { bucket, prefix, .. }) => write!(out, "s3://{bucket}/{prefix}"),
        }
    }
}

impl ObjectStorage {
    /// Opens the object store at a location.
    ///
    /// # Errors
    /// Returns an error if the folder cannot be created, or the settings of the bucket are not
    /// valid.
    pub fn open_at(place: &ObjectsPlace) -> Result<Self> {
        match place {
            ObjectsPlace::Folder(folder) => Self::open_folder(folder),
            ObjectsPlace::S3(place) => Ok(Self::from_store(
                bucket_store(bucket_builder(place), place).map_err(ObjectsError::from)?,
            )),
        }
    }
}

/// Returns the client of a bucket; credentials come from the environment.
pub(crate) fn bucket_builder(place: &S3Place) -> AmazonS3Builder {
    let plain = place.endpoint.as_ref().is_some_and(|url| url.starts_with("http://"));
    let client = ClientOptions::new()
        .with_connect_timeout(CONNECT)
        .with_timeout(REQUEST)
        .with_allow_http(plain);
    let retry =
        RetryConfig { backoff: BackoffConfig::default(), max_retries: 5, retry_timeout: RETRY };
    let builder = AmazonS3Builder::from_env()
        .with_bucket_name(&place.bucket)
        .with_client_options(client)
        .with_retry(retry);
    let builder = match &place.endpoint {
        Some(endpoint) => builder.with_endpoint(endpoint),
        None => builder,
    };
    // The builder reads the credentials from the environment; the region has two common variables.
    let environment = || {
        ["AWS_REGION", "AWS_DEFAULT_REGION"].into_iter().find_map(|name| std::env::var(name).ok())
    };
    builder
        .with_region(place.region.clone().or_else(environment).unwrap_or_else(|| REGION.to_owned()))
}

/// Installs the cryptography of TLS in the process, once: no HTTP client can be created without it,
/// not even for plain HTTP.
pub fn provide_cryptography() {
    // An error means that it is installed already.
    let _ = rustls::crypto::ring::default_provider().install_default();
}

/// Returns the store of a bucket, below its prefix.
pub(crate) fn bucket_store(
    builder: AmazonS3Builder,
    place: &S3Place,
) -> object_store::Result<Arc<dyn ObjectStore>> {
    provide_cryptography();
    let store = builder.build()?;
    Ok(match place.prefix.as_str() {
        "" => Arc::new(store),
        prefix => Arc::new(PrefixStore::new(store, prefix)),
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_bucket_is_read_or_refused() {
        let read = |url: &str| ObjectsPlace::parse_s3(url, None, None);
        let ObjectsPlace::S3(place) = read("s3://samples/fleet/a/").unwrap() else { panic!() };
        assert_eq!((place.bucket.as_str(), place.prefix.as_str()), ("samples", "fleet/a"));
        assert_eq!(read("s3://samples").unwrap().to_string(), "s3://samples/");
        for wrong in [
            "",
            "samples",
            "s3://",
            "s3:///a",
            "gs://samples",
            "s3://user@host/a",
            "s3://samples/a//b",
        ] {
            assert!(
                matches!(read(wrong), Err(StoreError::Invalid { field: "objects_url", .. })),
                "{wrong}"
            );
        }
        let endpoint = ObjectsPlace::parse_s3("s3://samples", Some("localhost:9000".into()), None);
        assert!(matches!(endpoint, Err(StoreError::Invalid { field: "objects_endpoint", .. })));
    }
}
