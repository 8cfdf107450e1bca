"""What hsdm raises, by kind; each is also what Python programs catch for such a thing."""


class Error(Exception):
    """The base of all that hsdm raises of its own accord."""


class OptionError(Error, ValueError):
    """An option that is out of its range, told before any work: ``depth 40: must lie in [1, 16]``."""


class CloudError(Error, ValueError):
    """Points without a surface in them, or a mesh that is none."""


class FileError(Error, OSError):
    """A file that cannot be read or written: ``FILE:LINE: what, and what to do``; ``filename`` is its path."""

    def __str__(self) -> str:
        return str(self.args[0])  # an OSError with a file name would make another text of it


class Cancelled(Error):
    """The caller's ``progress`` returned False."""


class OutOfMemory(Error, MemoryError):
    """There was not enough memory; nothing leaks, and the arrays are as they were."""
