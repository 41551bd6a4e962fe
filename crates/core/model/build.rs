//! Makes a file that is added to or removed from `models` a reason to build again: `include_dir`
//! tracks only the files that it has found. Crates that depend on this one and embed a folder of
//! `models`, too, are then built again with it.

fn main() {
    println!("cargo:rerun-if-changed=../../../models");
}
