# The commands that are used daily: `just --list`.

# The whole loop on an embedded database, ending in demo-out/report.html.
demo:
    cargo run --release -p sistership -- demo

# The server on http://127.0.0.1:8080, with its data in ./data.
serve:
    cargo run --release -p sistership -- serve --data-dir data

# Every test; PostgreSQL is started by the tests where it is installed.
test:
    cargo test --workspace --tests

# Formatting and lints as in CI.
lint:
    cargo fmt --check
    cargo clippy --workspace --all-targets -- -D warnings

# All that CI runs.
ci:
    .ci/run

# Rewrites every generated file: schemas, the page of the zoo, the REST contract, the table of rights.
generate:
    UPDATE_SCHEMAS=1 UPDATE_ZOO=1 UPDATE_LAWS=1 cargo test --workspace --test zoo
    UPDATE_OPENAPI=1 cargo test --workspace --test openapi
    UPDATE_RIGHTS=1 cargo test -p sistership-api --lib the_table_is_written_down

# Wings, circles between modules, language of the sources.
structure:
    cargo test -p sistership-tests --test structure

# The accuracy benchmarks against published tables, with their figures.
accuracy:
    cargo test -p sistership-tests --test accuracy -- --nocapture

# Licences, sources and advisories of all dependencies (needs cargo-deny).
deny:
    cargo deny check

# Wheels, Debian package and container image in dist/, checked in clean roots.
release:
    tools/release

# The documentation of the code.
doc:
    cargo doc --workspace --no-deps --open
