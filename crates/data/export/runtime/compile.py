"""Compiles the library of FMUs for every platform into `../libraries`, with Zig of PyPI.

    python3 -m venv zig && zig/bin/pip install ziglang==0.17.1
    zig/bin/python compile.py

The same compiler gives the same bytes on any machine. `../libraries/SHA256SUMS` holds the hashes of
what was compiled and of what came of it: `sha256sum -c libraries/SHA256SUMS` in `..`, and a test.
A folder as an argument receives the libraries instead, without hashes.
"""

import hashlib
import pathlib
import struct
import subprocess
import sys
import tempfile

ZIG = "0.17.1"
FOLDER = pathlib.Path(__file__).resolve().parent
SOURCES = ["model.c", "fmi2.c", "fmi3.c"]
OPTIONS = ["-shared", "-O2", "-std=c99", "-Wall", "-Wextra", "-Werror", "-fvisibility=hidden", "-s"]
# glibc of 2012 and macOS of 2020: what came later has them. Windows has its C library since 10.
TARGETS = {
    "x86_64-linux.so": ["x86_64-linux-gnu.2.17"],
    "aarch64-linux.so": ["aarch64-linux-gnu.2.17"],
    "x86_64-windows.dll": ["x86_64-windows-gnu"],
    "darwin.dylib": ["x86_64-macos.11.0", "aarch64-macos.11.0"],
}
# Values of the field `cputype` and `cpusubtype` of a universal binary (mach-o/fat.h).
PROCESSORS = {"x86_64": (0x01000007, 3), "aarch64": (0x0100000C, 0)}
# Pages of macOS on ARM have 16 KiB.
PAGE_BITS = 14


def compiled(target, name, folder):
    """The bytes of the library for one target."""
    out = folder / name
    named = ["-install_name", f"@rpath/{name}"] if "macos" in target else ["-lm"]
    command = [sys.executable, "-m", "ziglang", "cc", "-target", target, *OPTIONS, *named]
    subprocess.run([*command, "-o", out, *SOURCES], cwd=FOLDER, check=True)
    return out.read_bytes()


def universal(slices):
    """A universal binary of macOS from the libraries of several processors."""
    head, body, end = struct.pack(">II", 0xCAFEBABE, len(slices)), b"", 0
    for processor, library in slices:
        start = ((end >> PAGE_BITS) + 1) << PAGE_BITS
        head += struct.pack(">IIIII", *PROCESSORS[processor], start, len(library), PAGE_BITS)
        body += bytes(start - (end or 8 + 20 * len(slices))) + library
        end = start + len(library)
    return head + body


def library(name, folder):
    """The library of a platform."""
    targets = TARGETS[name]
    slices = [(target.split("-")[0], compiled(target, name, folder)) for target in targets]
    return slices[0][1] if len(slices) == 1 else universal(slices)


def hashes(folder):
    """Lines of SHA256SUMS, with paths from the folder of the crate."""
    places = [place for place in FOLDER.rglob("*") if place.suffix in {".c", ".h", ".py"}]
    places += [folder / name for name in TARGETS]
    for place in sorted(places):
        yield f"{hashlib.sha256(place.read_bytes()).hexdigest()}  {place.relative_to(FOLDER.parent)}\n"


def main():
    version = subprocess.run([sys.executable, "-m", "ziglang", "version"], check=True,
                             capture_output=True, text=True).stdout.strip()
    if version != ZIG:
        sys.exit(f"this is Zig {version}: install ziglang=={ZIG}, whose bytes are known")
    libraries = FOLDER.parent / "libraries"
    out = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else libraries
    out.mkdir(exist_ok=True)
    for name in TARGETS:
        with tempfile.TemporaryDirectory() as scratch:
            (out / name).write_bytes(library(name, pathlib.Path(scratch)))
    if out == libraries:
        (out / "SHA256SUMS").write_text("".join(hashes(out)))


main()
