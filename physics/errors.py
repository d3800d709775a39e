"""The engine's own errors and warning."""


class InseparableError(ValueError):
    """No finite translation separates two regions, so they cannot be moved apart.

    Two half-planes that are not back to back, for instance.
    """

    def __init__(self, a: object, b: object) -> None:
        super().__init__(
            f"no finite translation separates {a!r} from {b!r}: their regions reach to infinity in "
            "directions that cross. Let at most one of the two be open that way"
        )
        self.a = a
        self.b = b

    def __reduce__(self) -> tuple[type["InseparableError"], tuple[object, object]]:
        """Support pickling, to another process for instance."""
        return type(self), (self.a, self.b)


class NoBodyError(KeyError):
    """A handle names no body: it was removed, or there never was one."""

    def __str__(self) -> str:
        """Return the message itself; a KeyError would put it into quotes."""
        return str(self.args[0])


class HitLimitWarning(RuntimeWarning):
    """A body has no room, or used up its hits of one step; then it does not bounce in that step."""
