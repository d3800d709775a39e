"""Typed, validated settings: frozen dataclasses, read from TOML and from the command line.

A schema is a frozen dataclass that derives from `Settings`. Its fields are numbers, text, truth
values, lists of numbers or texts, other schemas (a table of the TOML file) or `dict[str, Any]` (a
table that is passed on as it is). `read_settings` fills one; whatever is wrong is a `SettingsError`
that names the place, the key, what was expected and the nearest key that exists.
"""

import dataclasses
import difflib
import json
import math
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeVar, get_type_hints

T = TypeVar("T", bound="Settings")
Scalar = str | int | float | bool

COMMAND_LINE = "command line"


class SettingsError(ValueError):
    """A setting that is unknown, of the wrong type or out of its range."""


@dataclass(frozen=True)
class Rule:
    """What a value must satisfy besides its type; a list's rule holds for each of its items."""

    at_least: float | None = None
    above: float | None = None
    at_most: float | None = None
    choices: tuple[str, ...] | None = None

    def words(self) -> str:
        """Return the rule as a part of a sentence, empty where there is none."""
        bounds = (("at least", self.at_least), ("above", self.above), ("at most", self.at_most))
        parts = [f"{name} {bound:.10g}" for name, bound in bounds if bound is not None]
        if self.choices is not None:
            parts.append("one of " + ", ".join(map(repr, self.choices)))
        return " and ".join(parts)

    def allows(self, value: Any) -> bool:
        """Tell whether a value of the right type satisfies the rule."""
        return (
            (self.at_least is None or value >= self.at_least)
            and (self.above is None or value > self.above)
            and (self.at_most is None or value <= self.at_most)
            and (self.choices is None or value in self.choices)
        )


def setting(default: Any, meaning: str, **rule: Any) -> Any:
    """Return a dataclass field with its default, its meaning and its `Rule`."""
    metadata = {"meaning": meaning, "rule": Rule(**rule)}
    return field(default=default, metadata=metadata)


@dataclass(frozen=True)
class Settings:
    """Base of every schema: a field that breaks its type or rule raises `SettingsError`."""

    def __post_init__(self) -> None:
        for leaf in _fields(type(self)):
            if not leaf.is_table:
                object.__setattr__(
                    self, leaf.key, leaf.checked(getattr(self, leaf.key), "settings")
                )


@dataclass(frozen=True)
class Leaf:
    """One setting of a schema; `key` is its dotted path from the root."""

    key: str
    kind: Any
    rule: Rule
    meaning: str
    default: Any

    @property
    def is_table(self) -> bool:
        """Tell whether this is a table of settings of its own."""
        return isinstance(self.kind, type) and issubclass(self.kind, Settings)

    @property
    def is_free(self) -> bool:
        """Tell whether this is a table whose keys are nobody's business here."""
        return bool(self.kind == dict[str, Any])

    def expected(self) -> str:
        """Return what a value must be, in words."""
        if self.is_table or self.is_free:
            return "a table"
        rule = self.rule.words()
        each = ", each " if self.kind in _ITEMS else ", "
        return _TYPE_NAMES[self.kind] + (each + rule if rule else "")

    def checked(self, value: Any, source: str) -> Any:
        """Return the value as its type; raise `SettingsError` naming ``source`` if it is none."""
        try:
            return self._converted(value)
        except ValueError:
            raise SettingsError(
                f"{source}: {self.key!r} must be {self.expected()}, not {_shown(value)}"
            ) from None

    def parsed(self, text: str) -> Any:
        """Return the value that a command line's text means (unchecked)."""
        return text if self.kind is str else parse_toml_value(text)

    def _converted(self, value: Any) -> Any:
        if self.is_free:
            if not isinstance(value, Mapping):
                raise ValueError
            return dict(value)
        if self.kind in _ITEMS:
            if not isinstance(value, list | tuple):
                raise ValueError
            return tuple(self._scalar(item, _ITEMS[self.kind]) for item in value)
        return self._scalar(value, self.kind)

    def _scalar(self, value: Any, kind: Any) -> Scalar:
        # bool is a subclass of int, and `true` steps are a mistake.
        accepted = (int, float) if kind is float else (kind,)
        if type(value) not in accepted:
            raise ValueError
        converted: Scalar = kind(value)
        if isinstance(converted, float) and not math.isfinite(converted):
            raise ValueError
        if not self.rule.allows(converted):
            raise ValueError
        return converted


_TYPE_NAMES: dict[Any, str] = {
    int: "an integer",
    float: "a number",
    str: "a text",
    bool: "true or false",
    tuple[int, ...]: "a list of integers",
    tuple[float, ...]: "a list of numbers",
    tuple[str, ...]: "a list of texts",
}
# Lists, and what they are of.
_ITEMS: dict[Any, Any] = {tuple[int, ...]: int, tuple[float, ...]: float, tuple[str, ...]: str}


def read_settings(
    schema: type[T],
    table: Mapping[str, Any],
    source: str,
    overrides: Sequence[tuple[str, str]] = (),
) -> T:
    """Return the settings of a table, changed by overrides ``(dotted key, text)``.

    ``source`` names the table's origin in errors. Raises `SettingsError`.
    """
    values = dict(_checked_table(schema, table, source))
    for key, text in overrides:
        _override(values, schema, key, text)
    try:
        return _build(schema, values)
    except SettingsError as error:
        # A rule between several settings: it is broken by the file or by what changed it.
        origin = f"{source} and {COMMAND_LINE}" if overrides else source
        raise SettingsError(f"{origin}: {error}") from None


def leaves(schema: type[Settings], prefix: str = "") -> Iterator[Leaf]:
    """Yield every setting of a schema with its dotted key, tables before what is in them."""
    for leaf in _fields(schema):
        rooted = dataclasses.replace(leaf, key=prefix + leaf.key)
        yield rooted
        if leaf.is_table:
            yield from leaves(leaf.kind, f"{rooted.key}.")


def to_toml(settings: Settings) -> str:
    """Return settings as a TOML document that `read_settings` reads back to equal ones."""
    return toml_table(dataclasses.asdict(settings))


def toml_table(table: Mapping[str, Any]) -> str:
    """Return a table, and the tables in it, as a TOML document."""
    return "\n".join(_toml_lines(table, ())).strip() + "\n"


def check_value(schema: type[Settings], key: str, value: Any, source: str) -> None:
    """Refuse a value that a setting cannot take, and a setting that is none."""
    known = {leaf.key: leaf for leaf in leaves(schema)}
    table, _, name = key.partition(".")
    if name and table in known and known[table].is_free:
        return
    if key not in known or known[key].is_table:
        raise _unknown(key, known, source)
    known[key].checked(value, source)


def _fields(schema: type[Settings]) -> tuple[Leaf, ...]:
    hints = get_type_hints(schema)
    found = []
    for item in dataclasses.fields(schema):
        factory = item.default_factory
        default = item.default if factory is dataclasses.MISSING else factory()
        rule, meaning = item.metadata.get("rule", Rule()), item.metadata.get("meaning", "")
        found.append(Leaf(item.name, hints[item.name], rule, meaning, default))
    return tuple(found)


def _checked_table(
    schema: type[Settings], table: Mapping[str, Any], source: str, prefix: str = ""
) -> Iterator[tuple[str, Any]]:
    """Yield (dotted key, checked value) of everything that a table sets."""
    known = {leaf.key: leaf for leaf in leaves(schema)}
    for name, value in table.items():
        key = prefix + name
        if key not in known:
            raise _unknown(key, known, source)
        if not known[key].is_table:
            yield key, known[key].checked(value, source)
        elif isinstance(value, Mapping):
            yield from _checked_table(schema, value, source, f"{key}.")
        else:
            raise SettingsError(f"{source}: {key!r} must be a table, not {_shown(value)}")


def _override(values: dict[str, Any], schema: type[Settings], key: str, text: str) -> None:
    """Change ``values`` by one ``--key text`` of the command line."""
    known = {leaf.key: leaf for leaf in leaves(schema)}
    table, _, name = key.partition(".")
    if name and table in known and known[table].is_free:
        values[table] = {**values.get(table, known[table].default), name: parse_toml_value(text)}
    elif key not in known or known[key].is_table:
        raise _unknown(key, known, COMMAND_LINE)
    else:
        values[key] = known[key].checked(known[key].parsed(text), COMMAND_LINE)


def _unknown(key: str, known: Mapping[str, Leaf], source: str) -> SettingsError:
    settable = [name for name, leaf in known.items() if not leaf.is_table]
    # The last part is compared too: `learning_rate` in the wrong table means `ppo.learning_rate`.
    by_last_part = {name.rpartition(".")[2]: name for name in settable}
    close = difflib.get_close_matches(key, settable, n=1)
    close += [by_last_part[part] for part in difflib.get_close_matches(key, by_last_part, n=1)]
    if not close:
        # Always name one: the nearest there is, however far.
        close = difflib.get_close_matches(key, settable, n=1, cutoff=0.0)
    nearest = known[close[0]]
    return SettingsError(
        f"{source}: unknown key {key!r}; "
        f"the nearest known key is {nearest.key!r} ({nearest.expected()})"
    )


def _build(schema: type[T], values: Mapping[str, Any], prefix: str = "") -> T:
    arguments = {}
    for leaf in _fields(schema):
        key = prefix + leaf.key
        if leaf.is_table:
            arguments[leaf.key] = _build(leaf.kind, values, f"{key}.")
        elif key in values:
            arguments[leaf.key] = values[key]
    return schema(**arguments)


def parse_toml_value(text: str) -> Any:
    """Return what the text means in TOML, or the text itself where it means nothing there."""
    try:
        table = tomllib.loads(f"value = {text}")
    except tomllib.TOMLDecodeError:
        return text
    # A line break in the text could have smuggled in more than the one value.
    return table["value"] if set(table) == {"value"} else text


def _shown(value: Any) -> str:
    return f"the text {value!r}" if isinstance(value, str) else repr(value)


def _toml_lines(table: Mapping[str, Any], path: tuple[str, ...]) -> Iterator[str]:
    for key, value in table.items():
        if not isinstance(value, Mapping):
            yield f"{_toml_key(key)} = {toml_value(value)}"
    for key, value in table.items():
        if isinstance(value, Mapping):
            inner = (*path, key)
            yield ""
            yield f"[{'.'.join(map(_toml_key, inner))}]"
            yield from _toml_lines(value, inner)


def _toml_key(key: str) -> str:
    bare = key.isascii() and key.replace("-", "").replace("_", "").isalnum()
    return key if bare else toml_value(key)


def toml_value(value: Any) -> str:
    """Return a value as TOML's text."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        # JSON's escapes are TOML's, but TOML wants DEL escaped, too.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(toml_value, value))}]"
    if isinstance(value, Mapping):
        items = (f"{_toml_key(key)} = {toml_value(item)}" for key, item in value.items())
        return "{" + ", ".join(items) + "}"
    return str(value)
