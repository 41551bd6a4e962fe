//! Compiles what an FMU carries beside the model: a shared library for Linux on x86-64, so that who
//! uses the FMU needs no compiler. Elsewhere FMUs carry sources only.

use std::path::{Path, PathBuf};

type Error = Box<dyn std::error::Error>;

fn main() -> Result<(), Error> {
    println!("cargo:rerun-if-changed=runtime");
    let out = PathBuf::from(std::env::var("OUT_DIR")?);
    let target = |what: &str| std::env::var(format!("CARGO_CFG_TARGET_{what}")).unwrap_or_default();
    let is_known = target("ARCH") == "x86_64" && target("OS") == "linux";
    for version in ["fmi2", "fmi3"] {
        let library = out.join(format!("{version}.so"));
        if is_known {
            compile(version, &library)?;
        } else {
            std::fs::write(&library, [])?;
        }
    }
    Ok(())
}

fn compile(version: &str, library: &Path) -> Result<(), Error> {
    let mut build = cc::Build::new();
    build.opt_level(2).debug(false).pic(true).warnings(true).std("c99");
    build.define("SISTERSHIP_OLD_GLIBC", None).flag("-fvisibility=hidden");
    let mut command = build.try_get_compiler()?.to_command();
    command.arg("-shared").args(["runtime/model.c", &format!("runtime/{version}.c")]);
    command.arg("-o").arg(library).args(["-lm", "-s"]);
    let status = command.status()?;
    if status.success() { Ok(()) } else { Err(format!("{command:?}: {status}").into()) }
}
