"""A reconstruction on its own thread."""

import time

import hsdm
import scans
from hsdm_blender import clouds
from hsdm_blender.job import Job, ScanFile


def wait_for(condition, seconds=30):
    begun = time.monotonic()
    while not condition():
        if time.monotonic() - begun > seconds:
            raise AssertionError("waited in vain")
        time.sleep(0.01)


class JobTest(scans.BlenderTest):
    def test_it_runs_beside_and_gives_what_the_package_gives(self):
        points, normals = scans.scan_of_box()
        job = Job(hsdm, clouds.Cloud(points, normals), {"depth": 4})
        job.start()
        wait_for(job.is_done)
        self.assertIsNone(job.error)
        self.assertEqual(job.mesh.digest(), hsdm.reconstruct(points, normals, depth=4).digest())

    def test_it_is_cancelled_long_before_its_end_and_has_no_mesh(self):
        points, normals = scans.scan_of_box(400000)
        job = Job(hsdm, clouds.Cloud(points, normals), {"depth": 10})
        job.start()
        wait_for(lambda: job.share > 0)
        job.cancel()
        begun = time.monotonic()
        wait_for(job.is_done)
        self.assertLess(time.monotonic() - begun, 5)
        self.assertTrue(job.was_cancelled)
        self.assertIsNone(job.mesh)
        self.assertIsNone(job.error)

    def test_what_a_file_lacks_is_an_error_of_the_job(self):
        job = Job(hsdm, ScanFile("/nowhere/absent.ply"), {})
        job.start()
        wait_for(job.is_done)
        self.assertIsInstance(job.error, hsdm.FileError)
        self.assertFalse(job.was_cancelled)
