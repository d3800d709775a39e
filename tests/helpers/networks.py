"""Networks of `agents.learn.portable`, computed by this processor's kernel."""

import json
from typing import Any

import numpy as np
from arkanoid.agents.learn.portable.recording import Numbers
from arkanoid.envs.browser.network import think
from arkanoid.envs.browser.records import Network, Operation
from numpy.typing import NDArray


class NativeNetwork:
    """A network, laid out as a browser lays it out.

    Args:
        header: what its file says of it; operations, weights: what follows there.
    """

    def __init__(self, header: dict[str, Any], operations: bytes, weights: bytes) -> None:
        self.header = header
        self._operations = np.frombuffer(operations, Operation).copy()
        computed = np.zeros(header["computed"], np.float32)
        self._memory = np.concatenate([computed, np.frombuffer(weights, "<f4")])
        place, count = header["outputs"]
        self._probabilities = np.zeros(count)
        self.network = np.zeros(1, Network)
        self._fill(self.network[0], place, count)

    @classmethod
    def of_file(cls, file: bytes) -> "NativeNetwork":
        """Return the network of a file."""
        length = 4 + int.from_bytes(file[:4], "little")
        header = json.loads(file[4:length])
        operations = length + header["operations"] * Operation.itemsize
        return cls(header, file[length:operations], file[operations:])

    def _fill(self, record: Any, place: int, count: int) -> None:
        sees = self.header["sees"]
        record.inputs = sees["inputs"]
        record.pictures, record.channels = sees.get("pictures", 0), sees.get("channels", 0)
        record.weights = self._memory.ctypes.data + 4 * self.header["computed"]
        record.operations = self._operations.ctypes.data
        record.num_operations = len(self._operations)
        record.outputs, record.num_outputs = place, count
        record.worth = self.header["value"]
        record.probabilities = self._probabilities.ctypes.data

    def part(self, first: int, count: int) -> NDArray[np.float32]:
        """Return numbers of the memory; the first weight has place 0."""
        begins = self.header["computed"] + first
        return self._memory[begins : begins + count]

    def numbers(self, numbers: Numbers) -> NDArray[np.float32]:
        """Return numbers that were recorded, in the order of torch."""
        begins = self._memory[self.header["computed"] + numbers.first :]
        steps = [4 * step for step in numbers.steps]
        return np.lib.stride_tricks.as_strided(begins, numbers.shape, steps).copy()

    def judge(self, observation: NDArray[Any]) -> NDArray[np.float64]:
        """Return the outputs, the value and the probabilities, float64 [2 * outputs + 1].

        Args:
            observation: as torch has it; a picture as uint8 [pictures, rows, columns, channels].
        """
        seen = np.ascontiguousarray(observation)
        self.network[0].observation = seen.ctypes.data
        think(self.network[0])
        outputs = self.part(*self.header["outputs"])
        return np.concatenate([outputs, self.network["value"], self._probabilities])
