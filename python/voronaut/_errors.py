"""What can go wrong, each with what to do about it (`help`)."""


class Error(Exception):
    """What voronaut refuses or cannot do: what, where, and in `help` what to do."""

    def __init__(self, what: str, help: str = "") -> None:
        super().__init__(f"{what}\n  help: {help}" if help else what)
        self.what = what
        self.help = help


class InputError(Error, ValueError):
    """A text, a file or an array is not what it should be."""


class DomainError(Error, ValueError):
    """The domain is none: it crosses itself, is open or empty."""


class MetricError(Error, ValueError):
    """The metric is not symmetric positive definite, or not finite, somewhere."""


class UnsupportedError(Error, ValueError):
    """What is asked for is not there for this domain or with these options."""


class MeshError(Error, RuntimeError):
    """A mesh is not valid."""


class FileError(Error, OSError):
    """A file cannot be read or written."""


class LimitError(Error, RuntimeError):
    """The work takes, or would take, more time or memory than its limit."""


class Cancelled(Error):
    """The `progress` function said stop."""
