"""Work of a graphics card that is recorded once, and then begun with a single call."""

from collections.abc import Callable

import torch


class Replayed:
    """A function without arguments that does the same work, on the same tensors, in each call.

    A card's processor is often done before Python has asked for the next piece of work. So the
    second call records the work as a CUDA graph, and later calls replay it. On other devices each
    call calls the function.

    Args:
        function: it neither waits for the card nor looks at numbers there.
        device: where it works.
        plain_calls: so many calls come before the recording, for what is made at the first use.
    """

    def __init__(
        self, function: Callable[[], None], device: torch.device, plain_calls: int = 1
    ) -> None:
        self._function = function
        self._plain_calls = plain_calls if device.type == "cuda" else -1
        self._graph: torch.cuda.CUDAGraph | None = None

    def __call__(self) -> None:
        """Do the work."""
        if self._graph is not None:
            self._graph.replay()
            return
        if self._plain_calls != 0:
            self._plain_calls -= 1
            self._function()
            return
        graph = torch.cuda.CUDAGraph()
        with torch.cuda.graph(graph):
            self._function()
        self._graph = graph
        graph.replay()
