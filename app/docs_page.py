"""The interface as one page for people, made from the OpenAPI document: no scripts, nothing fetched."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from html import escape
from typing import Any

METHODS = ("get", "post", "put", "patch", "delete")
MOST_EXAMPLE = 4000
"""Characters of an example that are shown."""
_PLACE = re.compile(r"\{(\w+)[^}]*\}")
_REFERENCE = "#/components/schemas/"
_STYLE = """
:root { color-scheme: light dark; }
body { font: 15px/1.5 system-ui, sans-serif; margin: 0 auto; max-width: 64rem; padding: 1rem; }
h2 { margin-top: 2.5rem; } h3 { margin: 0; font-size: 1rem; }
code, pre { font: 13px/1.5 ui-monospace, monospace; } code { overflow-wrap: anywhere; }
pre, .wide { overflow-x: auto; } pre { border: 1px solid #8886; border-radius: 6px; padding: .6rem; }
section { border-top: 1px solid #8886; padding: 1rem 0; } section p { margin: .4rem 0; }
table { border-collapse: collapse; } th, td { text-align: left; vertical-align: top; padding: .2rem 1rem .2rem 0; }
nav { display: flex; flex-wrap: wrap; gap: .3rem 1rem; } b { text-transform: uppercase; }
"""


def render(document: Mapping[str, Any], *, base: str, keys: bool) -> str:
    """The page; `base` is the server's address for examples, `keys` whether calls need an API key."""
    groups: dict[str, list[str]] = {}
    for path, method, operation in _operations(document):
        tag = (operation.get("tags") or ["other"])[0]
        groups.setdefault(tag, []).append(_section(document, path, method, operation, base=base, keys=keys))
    info = document["info"]
    links = "".join(f'<a href="#{escape(tag)}">{escape(tag)}</a>' for tag in groups)
    body = "".join(f'<h2 id="{escape(tag)}">{escape(tag)}</h2>{"".join(found)}' for tag, found in groups.items())
    return (
        '<!doctype html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{escape(info['title'])}: the interface</title><style>{_STYLE}</style></head><body>"
        f"<h1>{escape(info['title'])} {escape(info['version'])}</h1><p>{escape(info['description'])}</p>"
        "<p>This page lists what there is and how to call it; it sends nothing itself. "
        '<a href="/openapi.json">The OpenAPI document</a> has every field with its bounds, for tools; '
        f'<a href="/">the dashboard</a> uses these calls and no others.{_KEYS if keys else ""}</p>'
        f"<nav>{links}</nav>{body}</body></html>"
    )


_KEYS = " Calls need an API key here: put yours in <code>$KEY</code>."


def _operations(document: Mapping[str, Any]) -> Iterator[tuple[str, str, Mapping[str, Any]]]:
    for path, operations in document["paths"].items():
        for method in METHODS:
            if method in operations:
                yield path, method, operations[method]


def _section(
    document: Mapping[str, Any], path: str, method: str, operation: Mapping[str, Any], *, base: str, keys: bool
) -> str:
    about = operation.get("description") or operation.get("summary", "")
    replies = ", ".join(operation.get("responses", {}))
    call = curl(document, path, method, operation, base=base, keys=keys)
    told = "".join(f"<p>{escape(part)}</p>" for part in about.split("\n\n"))
    return (
        f"<section><h3><b>{method}</b> <code>{escape(path)}</code></h3>{told}"
        f"{_parameters(operation.get('parameters', []))}<pre>{escape(call)}</pre>"
        f"<p>Answers: {escape(replies)}</p></section>"
    )


def _parameters(parameters: Sequence[Mapping[str, Any]]) -> str:
    if not parameters:
        return ""
    rows = "".join(
        f"<tr><td><code>{escape(p['name'])}</code></td>"
        f"<td>{escape(p['in'])}{', required' if p.get('required') else ''}</td>"
        f"<td>{escape(kind(p['schema']))}</td><td>{escape(p.get('description', ''))}</td></tr>"
        for p in parameters
    )
    return f'<div class="wide"><table><tr><th>Parameter</th><th>In</th><th>Takes</th><th></th></tr>{rows}</table></div>'


_BOUNDS = (("exclusiveMinimum", "> "), ("minimum", ">= "), ("exclusiveMaximum", "< "), ("maximum", "<= "))


def kind(schema: Mapping[str, Any]) -> str:
    """What a parameter takes: `integer >= 1, <= 200; 50 by default`, or the words there are."""
    found = [kind(s) for s in schema.get("anyOf", ()) if s.get("type") != "null"]
    if schema.get("type") == "array":
        found = [f"several: {kind(schema['items'])}"]
    elif "enum" in schema:
        found = [" | ".join(map(str, schema["enum"]))]
    elif "$ref" in schema:
        found = [str(schema["$ref"]).removeprefix(_REFERENCE)]
    elif not found:
        bounds = ", ".join(f"{sign}{schema[key]}" for key, sign in _BOUNDS if key in schema)
        found = [f"{schema.get('type', 'any value')} {bounds}".strip()]
    default = schema.get("default")
    return " or ".join(found) + (f"; {json.dumps(default)} by default" if default is not None else "")


def curl(
    document: Mapping[str, Any], path: str, method: str, operation: Mapping[str, Any], *, base: str, keys: bool
) -> str:
    """A call to copy: places in the path in capitals, what the query must have, the schema's own example as body."""
    needed = [p["name"] for p in operation.get("parameters", ()) if p["in"] == "query" and p.get("required")]
    query = "&".join(f"{name}={name.upper()}" for name in needed)
    address = base + _capital(path)
    parts = ["curl -s" + ("" if method == "get" else f" -X {method.upper()}")]
    parts += ['-H "Authorization: Bearer $KEY"'] if keys and path.startswith("/v1") else []
    parts.append(f"'{address}{'?' + query if query else ''}'")
    content = operation.get("requestBody", {}).get("content", {})
    if "application/json" in content:
        example = _example(document, content["application/json"].get("schema", {}))
        body = json.dumps(example, indent=1)[:MOST_EXAMPLE] if example is not None else "{}"
        parts.append("-H 'Content-Type: application/json' -d '" + body.replace("'", "'\\''") + "'")
    for form in (value for name, value in content.items() if name.startswith("multipart/")):
        parts += [f"-F {name}=@FILE" for name in form["schema"].get("properties", {})]
    return " \\\n  ".join(parts)


def _capital(path: str) -> str:
    """What is to be filled in, in capitals."""
    return _PLACE.sub(lambda found: found[1].upper(), path)


def _example(document: Mapping[str, Any], schema: Mapping[str, Any]) -> object:
    """The first example of a schema, or of the first of its forms that has one."""
    if "$ref" in schema:
        schema = document["components"]["schemas"][str(schema["$ref"]).removeprefix(_REFERENCE)]
    if schema.get("examples"):
        return schema["examples"][0]
    return next((found for s in schema.get("anyOf", ()) if (found := _example(document, s)) is not None), None)
