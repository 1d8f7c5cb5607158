"""Reads an OpenAPI 3.0 description, says what is unsound in it, and judges answers by it.

In: the YAML text; answers as (status, headers, bytes). Out: operations, validators, sentences about what does not fit. Knows nothing of axisgate.
"""
import copy
import json
import re

import jsonschema
import yaml

METHODS = ("get", "put", "post", "delete", "options", "head", "patch", "trace")
KEYWORDS = {
    "title", "multipleOf", "maximum", "exclusiveMaximum", "minimum", "exclusiveMinimum", "maxLength", "minLength", "pattern", "maxItems", "minItems",
    "uniqueItems", "maxProperties", "minProperties", "required", "enum", "type", "allOf", "oneOf", "anyOf", "not", "items", "properties",
    "additionalProperties", "description", "format", "default", "nullable", "discriminator", "readOnly", "writeOnly", "xml", "externalDocs", "example",
    "deprecated"}
TYPES = {"array", "boolean", "integer", "number", "object", "string"}
TIME = re.compile(r"^\d{4}-(0[1-9]|1[0-2])-(0[1-9]|[12]\d|3[01])T([01]\d|2[0-3]):[0-5]\d:([0-5]\d|60)(\.\d+)?(Z|[+-]([01]\d|2[0-3]):[0-5]\d)$")
FORMATS = jsonschema.FormatChecker(formats=())


@FORMATS.checks("date-time")
def _is_time(value):
    return not isinstance(value, str) or bool(TIME.match(value))


class _Loader(yaml.SafeLoader):
    """Refuses keys that stand twice, and reads times as the texts that they are in JSON."""


def _mapping(loader, node, deep=False):
    keys = [loader.construct_object(k, deep=True) for k, _ in node.value]
    for k in keys:
        if keys.count(k) > 1:
            raise yaml.constructor.ConstructorError(None, None, f"{k!r} stands twice", node.start_mark)
        if not isinstance(k, str):
            raise yaml.constructor.ConstructorError(None, None, f"the key {k!r} is no text: put it in quotes", node.start_mark)
    return yaml.SafeLoader.construct_mapping(loader, node, deep=True)


_Loader.add_constructor("tag:yaml.org,2002:map", _mapping)
_Loader.yaml_implicit_resolvers = {k: [(tag, r) for tag, r in v if tag != "tag:yaml.org,2002:timestamp"] for k, v in yaml.SafeLoader.yaml_implicit_resolvers.items()}


def strict_json(data):
    """JSON as RFC 8259 has it: UTF-8, no NaN, no key twice."""
    def pairs(items):
        keys = [k for k, _ in items]
        assert len(keys) == len(set(keys)), f"a key stands twice: {keys}"
        return dict(items)

    def constant(name):
        raise ValueError(f"{name} is not JSON")
    return json.loads(data.decode("utf-8"), object_pairs_hook=pairs, parse_constant=constant)


class Operation:
    def __init__(self, description, path, method, item):
        self.description, self.path, self.method = description, path, method.upper()
        self.node = item[method]
        self.id = self.node.get("operationId", f"{method} {path}")
        own = [description.resolve(p) for p in self.node.get("parameters", [])]
        named = {(p["name"], p["in"]) for p in own}
        self.parameters = own + [p for p in map(description.resolve, item.get("parameters", [])) if (p["name"], p["in"]) not in named]
        body = description.resolve(self.node.get("requestBody", {}))
        self.request_media = list(body.get("content", {}))
        self.request_schema = next((c["schema"] for c in body.get("content", {}).values()), None)

    def names(self):
        return re.findall(r"\{(\w+)\}", self.path)

    def query(self):
        return [p for p in self.parameters if p["in"] == "query"]

    def response(self, status):
        """The documented answer: exact, else `default` for problems."""
        responses = self.node["responses"]
        found = responses.get(str(status), responses.get("default") if status >= 400 else None)
        return None if found is None else self.description.resolve(found)

    def good(self):
        return sorted(int(s) for s in self.node["responses"] if s.startswith("2"))

    def media(self, status):
        return list((self.response(status) or {}).get("content", {}))

    def wrong(self, status, headers, body):
        """What does not fit the description in this answer; empty if all does."""
        where = f"{self.method} {self.path} -> {status}"
        response = self.response(status)
        if response is None:
            return [f"{where}: this status is not described"]
        said = {k.lower(): v for k, v in headers.items()}
        out = []
        for name, header in response.get("headers", {}).items():
            header = self.description.resolve(header)
            if name.lower() not in said:
                out.append(f"{where}: the header {name} is missing")
            elif header["schema"].get("type") == "integer" and not re.fullmatch(r"-?\d+", said[name.lower()]):
                out.append(f"{where}: the header {name} is {said[name.lower()]}, no whole number")
        content = response.get("content", {})
        media = said.get("content-type", "").split(";")[0].strip()
        if not content:
            return out + ([f"{where}: a body of {len(body)} bytes where none is described"] if body else [])
        if media not in content:
            return out + [f"{where}: {media or 'no media type'} is not one of {', '.join(content)}"]
        if media.endswith("json"):
            try:
                document = strict_json(body)
            except (ValueError, AssertionError) as e:
                return out + [f"{where}: {e}: {body[:200]!r}"]
            validator = self.description.validator(content[media]["schema"])
            out += [f"{where}: {_place(e)}: {e.message[:300]}" for e in validator.iter_errors(document)]
        return out


def _place(error):
    return "/" + "/".join(map(str, error.absolute_path))


class Description:
    def __init__(self, text):
        self.text = text
        self.document = yaml.load(text, Loader=_Loader)
        self.operations = [Operation(self, path, m, item) for path, item in self.document["paths"].items() for m in METHODS if m in item]
        self._validators = {}

    def resolve(self, node):
        seen = 0
        while isinstance(node, dict) and "$ref" in node:
            target = self.document
            for part in node["$ref"].removeprefix("#/").split("/"):
                target = target[part]
            node = target
            seen += 1
            assert seen < 20, "a reference in a circle"
        return node

    def validator(self, schema):
        """A validator that also refuses members which are not described, unless additionalProperties speaks of them."""
        key = json.dumps(schema, sort_keys=True)
        if key not in self._validators:
            self._validators[key] = jsonschema.Draft202012Validator(self.translated(schema), format_checker=FORMATS)
        return self._validators[key]

    def translated(self, schema, inside=False):
        """JSON Schema 2020-12 of an OpenAPI 3.0 schema, references put in place. `inside`: a part of allOf, anyOf or oneOf."""
        schema = self.resolve(schema)
        out = {}
        for k, v in schema.items():
            if k in ("allOf", "anyOf", "oneOf"):
                out[k] = [self.translated(x, True) for x in v]
            elif k == "not":
                out[k] = self.translated(v, True)
            elif k == "items":
                out[k] = self.translated(v)
            elif k == "properties":
                out[k] = {name: self.translated(x) for name, x in v.items()}
            elif k == "additionalProperties":
                out[k] = v if isinstance(v, bool) else self.translated(v)
            elif k in ("exclusiveMinimum", "exclusiveMaximum"):
                if v:
                    out[k] = schema["minimum" if k == "exclusiveMinimum" else "maximum"]
            elif k in ("minimum", "maximum") and schema.get("exclusiveM" + k[1:]):
                pass
            elif k not in ("nullable", "example", "discriminator", "xml", "externalDocs", "readOnly", "writeOnly", "deprecated"):
                out[k] = v
        if schema.get("nullable") and "type" in schema:
            out["type"] = [schema["type"], "null"]
            if "enum" in schema:
                out["enum"] = [*schema["enum"], None]
        if not inside:
            members, open_end = self.members(schema)
            if members and not open_end:
                out["propertyNames"] = {"enum": sorted(members)}
        return out

    def members(self, schema):
        """Names of the members that an object of this schema may have, and whether it may have others."""
        schema = self.resolve(schema)
        names = set(schema.get("properties", {}))
        open_end = schema.get("additionalProperties", False) not in (False,)
        for k in ("allOf", "anyOf", "oneOf"):
            for part in schema.get(k, []):
                more, more_open = self.members(part)
                if not more and not more_open and k != "allOf" and self.resolve(part).get("type", "object") == "object" and not self.resolve(part).get("nullable"):
                    more_open = True  # an alternative that says nothing about its members
                names |= more
                open_end = open_end or more_open
        return names, open_end

    def unsound(self):
        """Everything that is wrong with the description itself, a sentence each."""
        d, out = self.document, []
        if not re.fullmatch(r"3\.0\.\d+", str(d.get("openapi"))):
            out.append("openapi is not 3.0.x")
        for k in ("title", "version"):
            if not isinstance(d.get("info", {}).get(k), str):
                out.append(f"info.{k} is missing")
        used = set()

        def references(node, path):
            if isinstance(node, dict):
                if "$ref" in node and isinstance(node["$ref"], str) and not path.endswith("/properties"):
                    if len(node) != 1:
                        out.append(f"{path}: what stands beside $ref is ignored by readers: {sorted(set(node) - {'$ref'})}")
                    try:
                        if not node["$ref"].startswith("#/"):
                            raise KeyError(node["$ref"])
                        self.resolve(node)
                        used.add(node["$ref"])
                    except (KeyError, TypeError):
                        out.append(f"{path}: {node['$ref']} leads nowhere")
                    return
                for k, v in node.items():
                    if k not in ("example", "enum") and (k != "default" or path.endswith("/responses")):
                        references(v, f"{path}/{k}")
            elif isinstance(node, list):
                for i, v in enumerate(node):
                    references(v, f"{path}/{i}")
        references(d, "")
        if any("leads nowhere" in x for x in out):
            return out
        # Security schemes are named by requirements, not by reference.
        needs = [d.get("security", [])] + [o.get("security", []) for item in d.get("paths", {}).values() for o in item.values() if isinstance(o, dict)]
        used |= {f"#/components/securitySchemes/{name}" for need in needs for choice in need for name in choice}
        for kind, items in d.get("components", {}).items():
            for name in items:
                if f"#/components/{kind}/{name}" not in used and f"`{name}`" not in self.text:
                    out.append(f"components/{kind}/{name} is used by nothing")

        def schema_at(node, path, inside=False):
            if "$ref" in node:
                return
            for k in node:
                if k not in KEYWORDS and not k.startswith("x-"):
                    out.append(f"{path}: {k} is no keyword of a schema")
            kind = node.get("type")
            if kind is not None and kind not in TYPES:
                out.append(f"{path}: {kind} is no type")
            if kind == "array" and "items" not in node:
                out.append(f"{path}: an array without items")
            if node.get("nullable") and kind is None:
                out.append(f"{path}: nullable without a type says nothing")
            for k, types in (("properties", ("object", None)), ("required", ("object", None)), ("items", ("array",)), ("pattern", ("string",)), ("minLength", ("string",)),
                             ("maxLength", ("string",)), ("minimum", ("integer", "number")), ("maximum", ("integer", "number"))):
                if k in node and kind not in types:
                    out.append(f"{path}: {k} is nothing for the type {kind}")
            for k in ("exclusiveMinimum", "exclusiveMaximum"):
                if k in node and not isinstance(node[k], bool):
                    out.append(f"{path}: {k} is true or false in OpenAPI 3.0")
            if "pattern" in node:
                try:
                    re.compile(node["pattern"])
                except re.error as e:
                    out.append(f"{path}: pattern: {e}")
            if "required" in node and (not node["required"] or len(set(node["required"])) != len(node["required"])):
                out.append(f"{path}: required is empty or has a name twice")
            if "enum" in node and (not node["enum"] or len({json.dumps(x) for x in node["enum"]}) != len(node["enum"])):
                out.append(f"{path}: enum is empty or has a value twice")
            if not inside:
                names, open_end = self.members(node)
                required = set(node.get("required", []))
                for part in node.get("allOf", []):
                    required |= set(self.resolve(part).get("required", []))
                for name in sorted(required - names):
                    if not open_end:
                        out.append(f"{path}: {name} is required but not described")
            for k in ("example", "default"):
                if k in node:
                    example_at(node, node[k], f"{path}/{k}")
            for k in ("allOf", "anyOf", "oneOf"):
                for i, x in enumerate(node.get(k, [])):
                    schema_at(x, f"{path}/{k}/{i}", True)
            for name, x in node.get("properties", {}).items():
                schema_at(x, f"{path}/properties/{name}")
            for k in ("items", "not", "additionalProperties"):
                if isinstance(node.get(k), dict):
                    schema_at(node[k], f"{path}/{k}")

        def example_at(schema, value, path):
            for e in self.validator({k: v for k, v in schema.items() if k not in ("example", "default")}).iter_errors(value):
                out.append(f"{path}: the example does not fit: {_place(e)}: {e.message[:200]}")

        def content_at(content, path):
            for media, c in content.items():
                schema_at(c["schema"], f"{path}/{media}/schema")
                if "example" in c:
                    example_at(c["schema"], c["example"], f"{path}/{media}/example")
                for name, example in c.get("examples", {}).items():
                    example_at(c["schema"], self.resolve(example)["value"], f"{path}/{media}/examples/{name}")

        def parameter_at(p, path):
            p = self.resolve(p)
            if p.get("in") not in ("path", "query", "header", "cookie") or not p.get("name") or "schema" not in p:
                out.append(f"{path}: a parameter needs name, in and schema")
                return
            if p["in"] == "path" and p.get("required") is not True:
                out.append(f"{path}: {p['name']} is in the path and must be required")
            schema_at(p["schema"], f"{path}/schema")
            if "example" in p:
                example_at(p["schema"], p["example"], f"{path}/example")

        def response_at(r, path):
            r = self.resolve(r)
            if not isinstance(r.get("description"), str):
                out.append(f"{path}: a response without a description")
            for name, h in r.get("headers", {}).items():
                h = self.resolve(h)
                schema_at(h["schema"], f"{path}/headers/{name}")
            content_at(r.get("content", {}), path)

        for name, s in d.get("components", {}).get("schemas", {}).items():
            # A schema that is only a part of others may require what they describe.
            schema_at(s, f"components/schemas/{name}")
        for kind, check in (("parameters", parameter_at), ("responses", response_at)):
            for name, x in d.get("components", {}).get(kind, {}).items():
                check(x, f"components/{kind}/{name}")

        tags = {t["name"] for t in d.get("tags", [])}
        ids = [o.id for o in self.operations]
        for path, item in d["paths"].items():
            if not path.startswith("/"):
                out.append(f"{path}: a path begins with /")
            for k in item:
                if k not in METHODS and k not in ("parameters", "summary", "description", "servers"):
                    out.append(f"{path}: {k} is no method")
        for o in self.operations:
            where = f"{o.method} {o.path}"
            if "operationId" not in o.node or ids.count(o.id) > 1:
                out.append(f"{where}: operationId is missing, or there twice")
            if not o.node.get("summary"):
                out.append(f"{where}: has no summary")
            for t in o.node.get("tags", []):
                if t not in tags:
                    out.append(f"{where}: the tag {t} is not described")
            told = [p["name"] for p in o.parameters if p["in"] == "path"]
            if sorted(told) != sorted(o.names()):
                out.append(f"{where}: path parameters {told} are not those of the path")
            keys = [(p["name"], p["in"]) for p in o.parameters]
            if len(keys) != len(set(keys)):
                out.append(f"{where}: a parameter stands twice")
            for i, p in enumerate(o.node.get("parameters", [])):
                parameter_at(p, f"{where}/parameters/{i}")
            if o.method in ("GET", "DELETE") and "requestBody" in o.node:
                out.append(f"{where}: takes no body")
            if "requestBody" in o.node:
                content_at(self.resolve(o.node["requestBody"])["content"], f"{where}/requestBody")
            responses = o.node.get("responses", {})
            if not any(re.fullmatch("[123]..", s) for s in responses):
                out.append(f"{where}: no answer is a good one")
            for status, r in responses.items():
                if not re.fullmatch(r"[1-5]\d\d|default", status):
                    out.append(f"{where}: {status} is no status")
                response_at(r, f"{where}/{status}")
        return list(dict.fromkeys(out))


def sample(description, schema, dice, required_only=False):
    """Some value that fits the schema, near enough to be a starting point."""
    schema = description.resolve(schema)
    if "example" in schema and dice.random() < 0.5:
        return copy.deepcopy(schema["example"])
    if "enum" in schema:
        return dice.choice(schema["enum"])
    for k in ("oneOf", "anyOf"):
        if k in schema:
            return sample(description, dice.choice(schema[k]), dice, required_only)
    if "allOf" in schema:
        out = {}
        for part in schema["allOf"]:
            value = sample(description, part, dice, required_only)
            if isinstance(value, dict):
                out.update(value)
        return out
    kind = schema.get("type", "object")
    if kind == "object":
        needed = set(schema.get("required", []))
        return {k: sample(description, v, dice, required_only) for k, v in schema.get("properties", {}).items() if k in needed or (not required_only and dice.random() < 0.5)}
    if kind == "array":
        return [sample(description, schema["items"], dice, required_only) for _ in range(dice.randint(schema.get("minItems", 0), 2))]
    if kind == "integer":
        return dice.randint(schema.get("minimum", -10), min(schema.get("maximum", 1000), 10**6))
    if kind == "number":
        return round(dice.uniform(0.1, 100.0), 3)
    if kind == "boolean":
        return dice.random() < 0.5
    return "".join(dice.choice("abcdefghijklmnop") for _ in range(max(schema.get("minLength", 1), dice.randint(1, 8))))
