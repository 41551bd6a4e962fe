"""Builds the container image of a static program without a registry or a daemon:

    python3 build.py PROGRAM ARCHIVE.tar [--architecture amd64]

The archive has the OCI image layout, and the `manifest.json` by which `docker load` reads it, too. Same
inputs give the same bytes: all times are `SOURCE_DATE_EPOCH` (0 by default). The image holds the program,
certificate authorities, and a user without privileges; there is no shell."""

from __future__ import annotations

import argparse
import datetime
import gzip
import hashlib
import io
import json
import os
import pathlib
import subprocess
import tarfile
from typing import Any, Dict, List, Optional

EPOCH = int(os.environ.get("SOURCE_DATE_EPOCH", "0"))
USER = 65532
AUTHORITIES = "etc/ssl/certs/ca-certificates.crt"
ACCOUNTS = {
    "etc/passwd": "root:x:0:0:root:/:/sbin/nologin\n"
                  f"sistership:x:{USER}:{USER}:Sistership:/var/lib/sistership:/sbin/nologin\n",
    "etc/group": f"root:x:0:\nsistership:x:{USER}:\n",
    # Hosts are found in /etc/hosts and by DNS.
    "etc/nsswitch.conf": "hosts: files dns\n",
}
FOLDERS = {"etc": (0, 0o755), "etc/ssl": (0, 0o755), "etc/ssl/certs": (0, 0o755),
           "tmp": (0, 0o1777), "usr": (0, 0o755), "usr/bin": (0, 0o755), "var": (0, 0o755),
           "var/lib": (0, 0o755), "var/lib/sistership": (USER, 0o750)}
OCI = "application/vnd.oci.image."


class Layer:
    """A layer under construction: a tar file with fixed times and owners."""

    def __init__(self) -> None:
        self.buffer = io.BytesIO()
        self.tar = tarfile.open(fileobj=self.buffer, mode="w", format=tarfile.USTAR_FORMAT)

    def add(self, name: str, content: Optional[bytes], owner: int, mode: int) -> None:
        """Adds a file; without content a folder."""
        entry = tarfile.TarInfo(name)
        entry.mtime, entry.mode, entry.uid, entry.gid = EPOCH, mode, owner, owner
        entry.type = tarfile.DIRTYPE if content is None else tarfile.REGTYPE
        entry.size = len(content or b"")
        self.tar.addfile(entry, io.BytesIO(content or b""))

    def finish(self) -> bytes:
        """The bytes of the tar file."""
        self.tar.close()
        return self.buffer.getvalue()


class Layout:
    """Blobs by their SHA-256, and their descriptors."""

    def __init__(self) -> None:
        self.blobs: Dict[str, bytes] = {}

    def add(self, content: bytes, media: str) -> Dict[str, Any]:
        """Adds a blob; gives its descriptor."""
        digest = hashlib.sha256(content).hexdigest()
        self.blobs[digest] = content
        return {"mediaType": OCI + media, "digest": f"sha256:{digest}", "size": len(content)}

    def add_json(self, document: Any, media: str) -> Dict[str, Any]:
        """Adds a document."""
        return self.add(json.dumps(document, sort_keys=True).encode(), media)


def system_layer() -> bytes:
    """Folders, users and certificate authorities."""
    layer = Layer()
    for name, (owner, mode) in FOLDERS.items():
        layer.add(name, None, owner, mode)
    for name, text in ACCOUNTS.items():
        layer.add(name, text.encode(), 0, 0o644)
    layer.add(AUTHORITIES, pathlib.Path("/", AUTHORITIES).read_bytes(), 0, 0o644)
    return layer.finish()


def program_layer(program: pathlib.Path) -> bytes:
    """The program."""
    layer = Layer()
    layer.add("usr/bin/sistership", program.read_bytes(), 0, 0o755)
    return layer.finish()


def image_config(version: str, architecture: str, layers: List[bytes]) -> Dict[str, Any]:
    """What a container of the image runs, and as whom."""
    created = datetime.datetime.fromtimestamp(EPOCH, datetime.timezone.utc).isoformat()
    health = {"Test": ["CMD", "/usr/bin/sistership", "health"], "Interval": 10 * 10**9,
              "Timeout": 6 * 10**9, "StartPeriod": 30 * 10**9, "Retries": 3}
    return {
        "architecture": architecture, "os": "linux", "created": created,
        "config": {
            "User": f"{USER}:{USER}",
            "Entrypoint": ["/usr/bin/sistership"], "Cmd": ["serve"],
            "Env": ["PATH=/usr/bin", "HOME=/var/lib/sistership", f"SSL_CERT_FILE=/{AUTHORITIES}",
                    "SISTERSHIP_DATA_DIR=/var/lib/sistership", "SISTERSHIP_LISTEN=0.0.0.0:8080"],
            "ExposedPorts": {"8080/tcp": {}}, "Volumes": {"/var/lib/sistership": {}},
            "WorkingDir": "/var/lib/sistership", "StopSignal": "SIGTERM", "Healthcheck": health,
            "Labels": {"org.opencontainers.image.title": "sistership",
                       "org.opencontainers.image.version": version,
                       "org.opencontainers.image.licenses": "MIT OR Apache-2.0"},
        },
        "rootfs": {"type": "layers", "diff_ids": [
            "sha256:" + hashlib.sha256(layer).hexdigest() for layer in layers]},
        "history": [{"created": created, "created_by": "packaging/image/build.py"}] * len(layers),
    }


def write_archive(path: pathlib.Path, layout: Layout, documents: Dict[str, Any]) -> None:
    """The archive: blobs, and documents by their names."""
    archive = Layer()
    for name, document in documents.items():
        archive.add(name, json.dumps(document, sort_keys=True).encode(), 0, 0o644)
    for folder in ("blobs", "blobs/sha256"):
        archive.add(folder, None, 0, 0o755)
    for digest, content in sorted(layout.blobs.items()):
        archive.add(f"blobs/sha256/{digest}", content, 0, 0o644)
    path.write_bytes(archive.finish())


def build(program: pathlib.Path, path: pathlib.Path, architecture: str) -> None:
    """Builds the image of a program."""
    run = [str(program.resolve()), "--version"]
    version = subprocess.run(run, check=True, capture_output=True, text=True).stdout.split()[1]
    layers = [system_layer(), program_layer(program)]
    layout = Layout()
    packed = [layout.add(gzip.compress(layer, 9, mtime=0), "layer.v1.tar+gzip") for layer in layers]
    config = layout.add_json(image_config(version, architecture, layers), "config.v1+json")
    manifest = layout.add_json({"schemaVersion": 2, "mediaType": OCI + "manifest.v1+json",
                                "config": config, "layers": packed}, "manifest.v1+json")
    name = f"localhost/sistership:{version}"
    manifest["annotations"] = {"org.opencontainers.image.ref.name": version,
                               "io.containerd.image.name": name}
    files = ["blobs/sha256/" + one["digest"][7:] for one in [config, *packed]]
    write_archive(path, layout, {
        "oci-layout": {"imageLayoutVersion": "1.0.0"},
        "index.json": {"schemaVersion": 2, "mediaType": OCI + "index.v1+json",
                       "manifests": [manifest]},
        "manifest.json": [{"Config": files[0], "RepoTags": [name], "Layers": files[1:]}],
    })


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("archive", type=pathlib.Path)
    parser.add_argument("--architecture", default="amd64")
    given = parser.parse_args()
    build(given.program, given.archive, given.architecture)
