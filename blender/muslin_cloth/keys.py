"""The keys of the scene file as the program declares them: sentences, ranges, defaults, words. scene_schema.json is
what `muslin schema` prints; tools/write_schema writes it. No Blender needed."""

import json
import pathlib
import re

_tables = json.loads(pathlib.Path(__file__).with_name("scene_schema.json").read_text(encoding="utf-8"))["$defs"]


def key(table, name, **chosen):
    """The JSON Schema of a key. `chosen` picks the table's variant, such as model="shell"."""
    for variant in _tables[table].get("oneOf", [_tables[table]]):
        keys = variant["properties"]
        if name in keys and all(keys[other]["enum"] == [word] for other, word in chosen.items()):
            return keys[name]
    raise KeyError(f"{table}.{name} {chosen}")


def default(table, name, **chosen):
    return key(table, name, **chosen)["default"]


def limits(table, name, **chosen):
    """`min` and `max` of a number, as properties of Blender take them."""
    numbers = key(table, name, **chosen)
    numbers = next((n for n in numbers.get("anyOf", ()) if n.get("type") in ("number", "integer")), numbers)
    whole = numbers["type"] == "integer"
    found = {}
    for limit, names in (("min", ("minimum", "exclusiveMinimum")), ("max", ("maximum",))):
        for bound in names:
            if bound in numbers:
                found[limit] = int(numbers[bound]) if whole else numbers[bound]
    return found


def words(table, name, **chosen):
    """The words that the value of the key may be."""
    allowed = key(table, name, **chosen)
    return next((form for form in allowed.get("anyOf", ()) if "enum" in form), allowed)["enum"]


def _plain(text):
    """Without Markdown."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text).replace("`", "").strip()
    return text[0].upper() + text[1:]


def sentence(table, name, **chosen):
    """The meaning of the key, for a tooltip."""
    return _plain(re.sub(r"\. (Default: |May change on --resume).*$", "", key(table, name, **chosen)["description"]))


def meaning(table, name, word):
    """The meaning of a word as the value of the key."""
    for quoted, text in re.findall(r'`"(\w+)"`[:,] ([^·]*)', key(table, name)["description"]):
        if quoted == word:
            return _plain(re.sub(r"\. Default: .*$", "", text))
    raise KeyError(f"{table}.{name} = {word}")
