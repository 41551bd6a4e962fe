//! How the released program is linked. On x86-64 Linux Rust brings its own linker, `lld`, which can
//! fold functions of the same machine code (generic code makes many: Chromium is linked so, with
//! the same SQLite and zstd) and pack the addresses that are set when the program is loaded.
//! Together that is 2.6 of 35 MB; docs/evidence/size.md.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let of = |name: &str| std::env::var(name).unwrap_or_default();
    let target = of("TARGET");
    if of("PROFILE") == "release" && target == "x86_64-unknown-linux-gnu" {
        println!("cargo:rustc-link-arg-bins=-Wl,--icf=all");
        println!("cargo:rustc-link-arg-bins=-Wl,-z,pack-relative-relocs");
        // Cargo 1.95 forgets the profile's `strip` for a package that has a profile of its own.
        println!("cargo:rustc-link-arg-bins=-Wl,--strip-all");
    }
}
