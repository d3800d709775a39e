"""Reads numbers from files of unknown origin, and runs no code that they contain.

`torch.save` writes a zip file with a pickle in it, and a pickle is a program. Here it may only
build tensors, numbers, texts, lists and tables.
"""

import io
import pickle
import pickletools
import warnings
import zipfile
from typing import Any

import torch

# What a pickle may look up by name, and pickle's other operations that look something up.
_STORAGES = ("Bool", "Byte", "Double", "Float", "Int", "Long")
_ALLOWED = {
    "collections OrderedDict",
    "torch._utils _rebuild_tensor_v2",
    *(f"torch {name}Storage" for name in _STORAGES),
}
_OTHER_LOOKUPS = {"STACK_GLOBAL", "INST", "OBJ", "NEWOBJ", "NEWOBJ_EX"}
_OTHER_LOOKUPS |= {"EXT1", "EXT2", "EXT4"}


def write_tensors(value: Any) -> memoryview:
    """Return tensors, numbers, texts, and lists and tables of them, as `torch.save` writes them."""
    buffer = io.BytesIO()
    torch.save(value, buffer)
    return buffer.getbuffer()


def read_tensors(content: bytes) -> Any:
    """Return what `write_tensors` wrote, or `torch.save` of a ``state_dict``.

    It takes at most a few times the memory of ``content``. Raises ValueError if the content is
    damaged or holds anything else.
    """
    try:
        checked = _repacked(content)
        with warnings.catch_warnings():
            # What is odd about a damaged file is no news: it is refused.
            warnings.simplefilter("ignore")
            return torch.load(checked, map_location="cpu", weights_only=True)
    except Exception as error:  # a damaged file can raise anything
        first_line = str(error).strip().partition("\n")[0]
        raise ValueError(first_line or type(error).__name__) from None


def is_like(value: Any, tensor: torch.Tensor) -> bool:
    """Tell whether a value is a tensor of the same shape and type, with its numbers in order."""
    return (
        type(value) is torch.Tensor
        and value.shape == tensor.shape
        and value.dtype == tensor.dtype
        and value.layout == torch.strided
        and value.device.type == "cpu"
        # Otherwise a single number could look like billions.
        and value.is_contiguous()
    )


def read_entry(archive: zipfile.ZipFile, name: str, limit: int) -> bytes:
    """Return a file in a zip file, and unpack at most ``limit`` bytes of it.

    Raises ValueError if it has more, or is packed in another way than `torch.save` or
    stable-baselines3 do.
    """
    entry = archive.getinfo(name)
    # `zipfile` unpacks other kinds without a limit: a few kilobytes would fill the memory.
    if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise ValueError(f"{name} is packed in an unknown way")
    with archive.open(entry) as file:
        # What the zip file says of the size may be a lie.
        content = file.read(limit + 1)
    if len(content) > limit:
        raise ValueError(f"{name} is larger than {limit:,} bytes")
    return content


def _repacked(content: bytes) -> io.BytesIO:
    """Return a copy of a zip file, so that torch reads exactly what was checked here.

    Reading compares the checksums; files that grow when they are unpacked are refused.
    """
    repacked = io.BytesIO()
    left = len(content)
    with (
        zipfile.ZipFile(io.BytesIO(content)) as archive,
        zipfile.ZipFile(repacked, "w") as copy,
    ):
        for name in dict.fromkeys(archive.namelist()):
            entry = read_entry(archive, name, left)
            left -= len(entry)
            if name.endswith(".pkl"):
                _check_pickle(entry)
            copy.writestr(name, entry)
    repacked.seek(0)
    return repacked


def _check_pickle(program: bytes) -> None:
    for operation, argument, _ in pickletools.genops(program):
        named = operation.name == "GLOBAL" and argument not in _ALLOWED
        if named or operation.name in _OTHER_LOOKUPS:
            raise pickle.UnpicklingError(
                f"it holds more than numbers ({argument or operation.name})"
            )
