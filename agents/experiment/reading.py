"""Settings from TOML and from the command line: read, checked by pydantic, explained, written.

A schema is a pydantic dataclass. Its fields are settings, tables of settings (dataclasses of their
own), or `dict[str, Any]`: a free table, whose keys are checked elsewhere.
"""

import difflib
import re
import shlex
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, TypeVar

import tomli_w
from pydantic import TypeAdapter, ValidationError

from ...envs.config import plain
from ...envs.reading import read_limited
from .errors import SettingsError
from .files import shown
from .numbers import as_whole, parse_whole
from .packaged import CONFIG, packaged_configs, read_packaged

T = TypeVar("T")

COMMAND_LINE = "command line"
_LARGEST_CONFIG = 2**20  # bytes
# Settings have keys of two parts. The time that `tomllib` needs grows with the square of a key's.
_MOST_DOTS = 8
# The pieces of a TOML text. A string without an end goes to the end of the line or text, so that no
# letter is read twice.
_PIECES = re.compile(
    r"""\"{3}(?:\\?.)*?(?:"{3,5}|\Z) | '{3}.*?(?:'{3,5}|\Z)
    | "(?:\\[^\n]|[^"\\\n])*"? | '[^'\n]*'? | \#[^\n]*
    | [^\s."'\#=,{}\[\]]+ | .""",
    re.DOTALL | re.VERBOSE,
)

_KINDS = {
    "integer": ("an integer", "a list of integers"),
    "number": ("a number", "a list of numbers"),
    "string": ("a text", "a list of texts"),
    "boolean": ("true or false", "a list of truth values"),
}
# JSON Schema's words, and ours.
_BOUNDS = {"minimum": "at least", "exclusiveMinimum": "above", "maximum": "at most"}


@dataclass(frozen=True)
class Setting:
    """What a user is told about a setting.

    Attributes:
        key: its dotted path.
        expected: what a value must be, in words.
        meaning: what the value decides.
        default: the value if none is given.
        is_text: whether a command line's words are the value, and not TOML.
        is_free: whether this is a free table.
        is_whole: whether the value is an integer, or a list of integers.
    """

    key: str
    expected: str
    meaning: str
    default: Any
    is_text: bool
    is_free: bool
    is_whole: bool


def describe_settings(schema: type[Any]) -> dict[str, Setting]:
    """Return every setting of a schema by its dotted key."""
    document = TypeAdapter(schema).json_schema()
    found = {}
    for name, entry in document["properties"].items():
        if "$ref" not in entry:
            found[name] = _setting(name, entry)
            continue
        table = document["$defs"][entry["$ref"].rpartition("/")[2]]
        for inner, inner_entry in table["properties"].items():
            found[f"{name}.{inner}"] = _setting(f"{name}.{inner}", inner_entry)
    return found


def _setting(key: str, entry: Mapping[str, Any]) -> Setting:
    kind = entry["type"]
    expected = "a table" if kind == "object" else _expected(entry)
    default = entry.get("default", {})
    is_whole = "integer" in (kind, entry.get("items", {}).get("type"))
    return Setting(
        key,
        expected,
        entry["description"],
        default,
        kind == "string",
        kind == "object",
        is_whole,
    )


def _expected(entry: Mapping[str, Any]) -> str:
    """Return what a part of a JSON schema asks for, in words."""
    is_list = entry["type"] == "array"
    value = entry["items"] if is_list else entry
    rules = [f"{words} {value[bound]:.10g}" for bound, words in _BOUNDS.items() if bound in value]
    if "enum" in value:
        rules.append("one of " + ", ".join(map(repr, value["enum"])))
    kind = _KINDS[value["type"]][is_list]
    return f"{kind}{', each ' if is_list else ', '}{' and '.join(rules)}" if rules else kind


def read_settings(
    schema: type[T],
    table: Mapping[str, Any],
    source: str,
    overrides: Sequence[tuple[str, str]] = (),
) -> T:
    """Return the settings of a table, changed by overrides ``(dotted key, text)``.

    ``source`` names the table's origin in errors. Raises `SettingsError`, which names the place,
    the key, what is expected and, of an unknown key, the one that is meant or all known ones.
    """
    known = describe_settings(schema)
    values = {
        key: dict(value) if isinstance(value, dict) else value for key, value in table.items()
    }
    for key, text in overrides:
        setting = _find(known, key, COMMAND_LINE)
        _set(values, key, text if setting.is_text else parse_toml_value(text))
    _make_whole(values, known)
    try:
        return TypeAdapter(schema).validate_python(values)
    except ValidationError as error:
        changed = {key for key, _ in overrides}
        raise _explained(error.errors()[0], known, values, source, changed) from None


def check_value(schema: type[Any], key: str, value: Any, source: str) -> None:
    """Raise `SettingsError` if there is no such setting, or if it cannot take the value.

    Rules that tie several settings together do not count.
    """
    known = describe_settings(schema)
    _find(known, key, source)
    values: dict[str, Any] = {}
    _set(values, key, value)
    _make_whole(values, known)
    try:
        TypeAdapter(schema).validate_python(values)
    except ValidationError as error:
        for problem in error.errors():
            if problem["type"] != "value_error":
                raise _explained(problem, known, values, source, set()) from None


def to_toml(settings: Any) -> str:
    """Return settings as a TOML document that `read_settings` reads back to equal ones."""
    return tomli_w.dumps(_without_none(asdict(settings)))


def to_toml_value(value: Any) -> str:
    """Return a setting's value as TOML, in one line."""
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(to_toml_value, value))}]"
    return tomli_w.dumps({"value": plain(value)}).removeprefix("value = ").rstrip()


def _without_none(table: Mapping[str, Any]) -> dict[str, Any]:
    """Return a table as TOML has it, which knows nothing like None."""
    return {
        key: _without_none(value) if isinstance(value, Mapping) else plain(value)
        for key, value in table.items()
        if value is not None
    }


def parse_toml_value(text: str) -> Any:
    """Return what the text means in TOML, or the text itself if it means nothing there.

    ``1e6`` is an integer here.
    """
    integer = parse_whole(text)
    if integer is not None:
        return integer
    try:
        table = parse_toml(f"value = {text}")
    except (ValueError, RecursionError):
        return text
    # A line break in the text could smuggle in more than the one value.
    return table["value"] if set(table) == {"value"} else text


def read_toml(config: str, suffix: str = CONFIG) -> tuple[str, dict[str, Any]]:
    """Return the name, for messages, and the content of a TOML file or of a packaged one's name.

    Raises `SettingsError` if it is missing or is not TOML.
    """
    source, text = _read_config(config, suffix)
    try:
        return source, parse_toml(text)
    except (ValueError, RecursionError) as error:  # also for huge numbers and deep nesting
        raise SettingsError(f"{source}: not a TOML file: {error}") from None


def parse_toml(text: str) -> dict[str, Any]:
    """Return the content of a TOML text, in a time that grows with its length.

    Raises ValueError or RecursionError if it is no TOML or has a key of many parts.
    """
    dots = 0
    for piece in _PIECES.finditer(text):
        if piece[0] in "\n=,{}[]":
            dots = 0
        dots += piece[0] == "."
        if dots > _MOST_DOTS:
            raise ValueError(f"a key has more than {_MOST_DOTS} dots")
    return tomllib.loads(text)


def _read_config(config: str, suffix: str) -> tuple[str, str]:
    """Return the name of a config for messages, and its text."""
    path = Path(config)
    try:
        if config in packaged_configs(suffix) and not path.is_file():
            return f"config {config!r}", read_packaged(config, suffix)
        return config, read_limited(path, _LARGEST_CONFIG).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise SettingsError(f"{config}: not a TOML file: it holds no text") from None
    except ValueError as error:
        raise SettingsError(f"{config}: not a TOML file: {error}") from None
    except OSError as error:
        names = ", ".join(packaged_configs(suffix))
        raise SettingsError(
            f"{config}: cannot be read ({error.strerror}); give the path of a TOML file or the "
            f"name of a packaged one: {names}"
        ) from None


def _find(known: Mapping[str, Setting], key: str, source: str) -> Setting:
    """Return the setting of a key, or the free table that it belongs to."""
    table = known.get(key.partition(".")[0])
    if table is not None and table.is_free and table.key != key:
        return table
    if key not in known:
        raise _unknown(key, known, source)
    return known[key]


def _set(values: dict[str, Any], key: str, value: Any) -> None:
    table, _, name = key.partition(".")
    if not name:
        values[key] = value
    elif isinstance(values.setdefault(table, {}), dict):
        values[table][name] = value


def _make_whole(values: dict[str, Any], known: Mapping[str, Setting]) -> None:
    """Replace floats without a fraction where integers belong: ``1e6`` is a million."""
    for key, setting in known.items():
        table, _, name = key.rpartition(".")
        place = values.get(table) if table else values
        if not setting.is_whole or not isinstance(place, dict) or name not in place:
            continue
        value = place[name]
        place[name] = [as_whole(one) for one in value] if type(value) is list else as_whole(value)


def _explained(
    problem: Mapping[str, Any],
    known: Mapping[str, Setting],
    values: Mapping[str, Any],
    source: str,
    changed: set[str],
) -> SettingsError:
    """Return a problem that pydantic found in our words; ``changed`` are overridden keys."""
    if problem["type"] == "value_error":
        # A rule that ties several settings together: the file breaks it, or what changed it.
        origin = f"{source} and {COMMAND_LINE}" if changed else source
        return SettingsError(f"{origin}: {problem['ctx']['error']}")
    table, *names = map(str, problem["loc"])
    # A place inside a list is not a key.
    key = f"{table}.{names[0]}" if names and table not in known else table
    value = values[table] if key == table else values[table][names[0]]
    origin = COMMAND_LINE if key in changed else source
    if problem["type"] == "unexpected_keyword_argument":
        if key in known:
            return SettingsError(
                f"{source}: {key!r} in quotation marks is one word; write it without them, or "
                f"in its table [{key.partition('.')[0]}]"
            )
        return _unknown(key, known, origin)
    expected = known[key].expected if key in known else "a table"
    told = f"{origin}: {key!r} must be {expected}, not {_shown(value)}"
    if (
        origin == COMMAND_LINE
        and expected.startswith("a list")
        and isinstance(value, str | int | float)
    ):
        told += f"; a list is typed as {shlex.quote(to_toml_value([value]))}"
    return SettingsError(told)


def _unknown(key: str, known: Mapping[str, Setting], source: str) -> SettingsError:
    # The last part is compared, too: `learning_rate` alone means `ppo.learning_rate`.
    by_last_part = {name.rpartition(".")[2]: name for name in known}
    close = difflib.get_close_matches(key, known, n=1)
    close += [by_last_part[part] for part in difflib.get_close_matches(key, by_last_part, n=1)]
    if close:
        nearest = known[close[0]]
        hint = f"the nearest known key is {nearest.key!r} ({nearest.expected})"
    else:
        table = f"{key.partition('.')[0]}."
        hint = f"known are {', '.join([name for name in known if name.startswith(table)] or known)}"
    return SettingsError(f"{source}: unknown key {key!r}; {hint}")


def _shown(value: Any) -> str:
    return f"the text {shown(value)}" if isinstance(value, str) else shown(value)
