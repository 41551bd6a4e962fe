"""Writes `src/sistership/core.py` from `api/openapi.json`: types, and a method for each
operation. `python generate.py --check` tells whether it is as it should be."""

import json
import keyword
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
TARGET = HERE / "src" / "sistership" / "core.py"
PLAIN = {"string": "str", "integer": "int", "number": "float", "boolean": "bool", "null": "None"}

HEAD = '''"""Types and operations of the REST interface, written by `generate.py`: not to be edited."""

from __future__ import annotations

from typing import Any, Dict, List, Literal, Optional, TypedDict, Union

from .http import Http

'''


def name_of(reference):
    return reference.rsplit("/", 1)[1]


def union(types):
    unique = list(dict.fromkeys(types))
    return unique[0] if len(unique) == 1 else f"Union[{', '.join(unique)}]"


def type_of(schema):
    """The annotation of a schema; what it says beyond that is the server's to check."""
    if "$ref" in schema:
        return name_of(schema["$ref"])
    for several in ("oneOf", "anyOf"):
        if several in schema:
            return union([type_of(one) for one in schema[several]])
    if "enum" in schema:
        return f"Literal[{', '.join(repr(value) for value in schema['enum'])}]"
    kind = schema.get("type")
    if isinstance(kind, list):
        return union([type_of({**schema, "type": one}) for one in kind])
    if kind == "array":
        return f"List[{type_of(schema.get('items', {}))}]"
    if kind == "object":
        further = schema.get("additionalProperties")
        value = type_of(further) if isinstance(further, dict) else "Any"
        return f"Dict[str, {value}]"
    return PLAIN.get(kind, "Any")


def is_record(schema):
    return schema.get("type") == "object" and bool(schema.get("properties"))


def record(name, schema):
    fields = schema["properties"]
    items = ", ".join(f"{field!r}: {type_of(one)!r}" for field, one in fields.items())
    total = set(schema.get("required", [])) == set(fields)
    return f"{name} = TypedDict({name!r}, {{{items}}}, total={total})\n"


def alias(name, schema):
    """What is no record is any value; its annotation would refer to what stands below it."""
    return f"{name} = Any  # {summary(schema)}\n"


def summary(schema):
    return " ".join(schema.get("description", "").split())[:70]


def identifier(name):
    plain = re.sub(r"\W", "_", name).lower()
    return plain + "_" if keyword.iskeyword(plain) else plain


def answer_of(operation):
    for status in ("200", "201", "202"):
        content = operation["responses"].get(status, {}).get("content", {})
        if "application/json" in content:
            return "json", type_of(content["application/json"]["schema"])
        if content:
            return "bytes", "bytes"
    return "none", "None"


def method(path, verb, operation):
    known = operation.get("parameters", [])
    of = {place: [p for p in known if p["in"] == place] for place in ("path", "query", "header")}
    signature = ["self"] + [f"{identifier(p['name'])}: {type_of(p['schema'])}" for p in of["path"]]
    content = operation.get("requestBody", {}).get("content", {})
    if "application/json" in content:
        signature.append(f"body: {type_of(content['application/json']['schema'])}")
    elif content:
        signature.append("body: bytes, media: str")
    signature.append("*")
    for p in of["query"] + of["header"]:
        kind = type_of(p["schema"])
        signature.append(f"{identifier(p['name'])}: Optional[{kind}] = None")
    if signature[-1] == "*":
        signature.pop()
    form, kind = answer_of(operation)
    filled = re.sub(r"{(\w+)}", lambda m: "{" + identifier(m[1]) + "}", path)
    pairs = {place: ", ".join(f"{p['name']!r}: {identifier(p['name'])}" for p in of[place])
             for place in ("query", "header")}
    call = [repr(verb.upper()), f"f{filled!r}" if "{" in filled else repr(filled)]
    call.append(f"query={{{pairs['query']}}}") if pairs["query"] else None
    call.append(f"headers={{{pairs['header']}}}") if pairs["header"] else None
    if "application/json" in content:
        call.append("json=body")
    elif content:
        call.append("body=body, media=media")
    title = " ".join(operation.get("summary", operation["operationId"]).split())
    return (
        f"    def {identifier(operation['operationId'])}({', '.join(signature)}) -> {kind}:\n"
        f'        """{title}."""\n'
        f"        return self.http.{form}({', '.join(call)})\n"
    )


def text():
    document = json.loads((HERE.parents[1] / "api" / "openapi.json").read_text())
    parts = [HEAD]
    for name, schema in sorted(document["components"]["schemas"].items()):
        parts.append(record(name, schema) if is_record(schema) else alias(name, schema))
    parts.append('\n\nclass Core:\n    """Every operation by its name."""\n\n'
                 "    def __init__(self, http: Http) -> None:\n        self.http = http\n")
    for path, item in document["paths"].items():
        for verb, operation in item.items():
            parts.append("\n" + method(path, verb, operation))
    return "".join(parts)


if __name__ == "__main__":
    if "--check" in sys.argv:
        sys.exit(0 if TARGET.read_text() == text() else "core.py is old: run python generate.py")
    TARGET.write_text(text())
