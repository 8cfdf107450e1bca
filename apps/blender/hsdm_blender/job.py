"""A reconstruction on a thread of its own, so that Blender goes on meanwhile; it touches nothing of Blender's."""

from dataclasses import dataclass
import threading

from . import clouds


@dataclass
class ScanFile:
    """A file to be read, and the shifts of other objects (clouds.shift_for)."""

    path: str
    columns: str = ""
    shifts: tuple = ()


class Job:
    """Reads a file or takes a cloud, and reconstructs it. `mesh` or `error` is there once it is done."""

    def __init__(self, hsdm, source, options):
        """`source` is a ScanFile or a clouds.Cloud; `options` are keyword arguments of hsdm.reconstruct."""
        self._hsdm, self._source, self._options = hsdm, source, options
        self._cancelled = threading.Event()
        self._thread = threading.Thread(target=self.run, name="hsdm")
        self._host = threading.main_thread()
        self.phase, self.share = "reading", 0.0
        self.mesh = None
        self.error = None
        self.shift = None

    def start(self):
        self._thread.start()

    def is_done(self):
        return not self._thread.is_alive()

    @property
    def was_cancelled(self):
        """Whether nothing is to be made of it, also where it was asked to end when it had just been done."""
        return self._cancelled.is_set()

    def cancel(self):
        """Asks it to end, which takes some tenths of a second."""
        self._cancelled.set()

    def run(self, progress=None):
        """All of it, on the caller's thread; `progress` is called with phase and share."""
        try:
            cloud = self._cloud()
            self.shift = cloud.shift
            self.mesh = self._hsdm.reconstruct(
                **cloud.arguments(), **self._options, progress=lambda *told: self._goes_on(progress, *told)
            )
        except self._hsdm.Cancelled:
            self._cancelled.set()
        except Exception as error:  # told by the operator, whatever it is: an error in a thread is told by nobody
            self.error = error

    def _cloud(self):
        if isinstance(self._source, clouds.Cloud):
            return self._source
        points = self._hsdm.read_points(self._source.path, columns=self._source.columns)
        return clouds.cloud_of_points(points, self._source.shifts)

    def _goes_on(self, progress, phase, share):
        self.phase, self.share = phase, share
        if progress is not None:
            progress(phase, share)
        # Where Blender has been closed, Python waits for this thread, and nobody for what it does.
        return not self._cancelled.is_set() and self._host.is_alive()
