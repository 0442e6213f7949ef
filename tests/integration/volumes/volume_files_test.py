"""Voxel volumes from series of slices as manufacturers and archives write them: order, spacing and every value."""

import math
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

import series as s


class Series(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.temporary.name)
        self.folder = self.root / "ct"

    def tearDown(self):
        self.temporary.cleanup()

    def read(self, *options):
        return s.converted(self.folder, self.root / "out.nrrd", *options)

    def check_values(self, expected, slices=5, rows=12, columns=16):
        grid, _ = self.read()
        self.assertEqual(grid.size, [columns, rows, slices])
        wrong = [(i, j, k) for k in range(slices) for j in range(rows) for i in range(columns)
                 if grid[i, j, k] != expected(i, j, k)]
        self.assertEqual(wrong, [])
        return grid

    def test_is_ordered_by_position_and_in_hounsfield_units(self):
        s.save_all(self.folder, [s.slice_of(k) for k in range(5)])
        self.check_values(lambda i, j, k: s.value(i, j, k) - 1024)
        found = s.info(self.folder)
        self.assertEqual(found["size"], [16, 12, 5])
        self.assertEqual([round(1e3 * d, 9) for d in found["spacing_m"]], [0.5, 0.7, 2.5])
        self.assertTrue(found["hounsfield"])
        self.assertEqual(found["manufacturer"], "ACME, Ring 1")
        self.assertEqual(found["files"], [f"IM{(k * 7 + 3) % 97:04d}" for k in range(5)])
        self.assertEqual(found["warnings"], [])
        middle = [-30 + 7.5 * 0.5, -40 + 5.5 * 0.7, 105.0]
        for a, b in zip(found["X_PV"]["xyz_m"], middle):
            self.assertAlmostEqual(1e3 * a, b, places=6)

    def test_takes_numbers_of_instances_and_names_for_nothing(self):
        slices = [s.slice_of(k) for k in range(6)]
        numbers = list(range(6))
        random.Random(4).shuffle(numbers)
        for data, number in zip(slices, numbers):
            data.InstanceNumber = number
        s.save_all(self.folder, slices, lambda k: f"{5 - k}.dcm")
        self.check_values(lambda i, j, k: s.value(i, j, k) - 1024, slices=6)

    def test_from_head_to_feet_is_the_same_body(self):
        # Acquired downwards: positions fall, the orientation stays, so the last slice is the first one.
        s.save_all(self.folder, [s.slice_of(k, step=(0, 0, -2.5)) for k in range(5)])
        self.check_values(lambda i, j, k: s.value(i, j, 4 - k) - 1024)

    def test_sagittal_slices_have_their_own_axes(self):
        s.save_all(self.folder, [s.slice_of(k, row=(0, 1, 0), column=(0, 0, -1), step=(-3, 0, 0)) for k in range(5)])
        self.check_values(lambda i, j, k: s.value(i, j, k) - 1024)
        found = s.info(self.folder)
        self.assertEqual([round(1e3 * d, 9) for d in found["spacing_m"]], [0.5, 0.7, 3.0])
        self.assertEqual(found["X_PV"]["z"], [-1, 0, 0])

    def test_signed_values_of_12_bits_have_their_signs(self):
        s.save_all(self.folder, [s.slice_of(k, signed=True, slope=1, intercept=0) for k in range(5)])
        self.check_values(lambda i, j, k: s.value(i, j, k) - 2000)

    def test_bits_above_the_stored_ones_are_not_values(self):
        def data(k):
            pixels = [s.value(i, j, k) | 0xA000 for j in range(12) for i in range(16)]
            return s.slice_of(k, pixels=pixels)
        s.save_all(self.folder, [data(k) for k in range(5)])
        self.check_values(lambda i, j, k: s.value(i, j, k) - 1024)

    def test_sixteen_and_eight_bits(self):
        s.save_all(self.folder, [s.slice_of(k, stored=16) for k in range(5)])
        self.check_values(lambda i, j, k: s.value(i, j, k) - 1024)
        self.folder = self.root / "bytes"
        s.save_all(self.folder, [s.slice_of(k, bits=8, stored=8, slope=None,
                                            pixels=[s.value(i, j, k) % 256 for j in range(12) for i in range(16)])
                                 for k in range(5)])
        self.check_values(lambda i, j, k: s.value(i, j, k) % 256)
        self.assertFalse(s.info(self.folder)["hounsfield"])
        self.assertEqual(s.info(self.folder)["bytes"], 16 * 12 * 5)

    def test_rescale_is_that_of_each_slice(self):
        s.save_all(self.folder, [s.slice_of(k, slope=1, intercept=-1000 - 10 * k) for k in range(5)])
        self.check_values(lambda i, j, k: s.value(i, j, k) - 1000 - 10 * k)
        self.assertEqual(s.info(self.folder)["warnings"], [])
        # As of PET: another slope a slice.
        self.folder = self.root / "pet"
        slopes = [0.5, 1.25, 0.75, 2.0, 0.1]
        slices = [s.slice_of(k, slope=slopes[k], intercept=0) for k in range(5)]
        for data in slices:
            data.Modality = "PT"
        s.save_all(self.folder, slices)
        grid, warnings = self.read()
        self.assertIn("rounded to steps of 2", warnings)
        for k in range(5):
            for j in range(12):
                for i in range(16):
                    self.assertLessEqual(abs(grid[i, j, k] - slopes[k] * s.value(i, j, k)), 1.0001)

    def test_a_tilted_gantry_is_sheared_into_a_straight_volume(self):
        tilt = math.radians(12)
        rows = 40
        # A plane of the body, z + y / 4 in mm, which no slice holds the edge of.
        column = (0, math.cos(tilt), -math.sin(tilt))

        def body(y, z):
            return 1000 + 4 * y + 10 * z

        def data(k):
            pixels = [round(body(-40 + 0.7 * j * column[1], 100 + 2.5 * k + 0.7 * j * column[2]))
                      for j in range(rows) for i in range(16)]
            return s.slice_of(k, rows=rows, column=column, slope=None, pixels=pixels)
        s.save_all(self.folder, [data(k) for k in range(20)])
        grid, warnings = self.read()
        self.assertIn("tilted by 12.0 degrees", warnings)
        found = s.info(self.folder)
        self.assertAlmostEqual(1e3 * found["spacing_m"][2], 2.5 * math.cos(tilt), places=6)
        pose = found["X_PV"]
        compared = 0
        for k in range(20):
            for j in range(grid.size[1]):
                at = [0.0, 0.0, 0.0]
                for axis, index, size, spacing in (("y", j, grid.size[1], found["spacing_m"][1]),
                                                   ("z", k, 20, found["spacing_m"][2])):
                    for i in range(3):
                        at[i] += (index - (size - 1) / 2) * spacing * pose[axis][i] * 1e3
                y, z = (1e3 * pose["xyz_m"][i] + at[i] for i in (1, 2))
                # Where this place is within its slice, mm along the slice's column.
                along = (y + 40) * column[1] + (z - 100 - 2.5 * k) * column[2]
                if 0.01 <= along <= 0.7 * (rows - 1) - 0.01:
                    compared += 1
                    self.assertLessEqual(abs(grid[5, j, k] - body(y, z)), 1.5, (j, k))
        self.assertGreater(compared, 700)

    def test_what_is_no_slice_of_the_series_is_left_out_by_name(self):
        slices = [s.slice_of(k) for k in range(5)]
        s.save_all(self.folder, slices)
        (self.folder / "README.txt").write_text("scans")
        (self.folder / "DICOMDIR").write_bytes(b"\0" * 128 + b"DICM")
        (self.folder / "link.dcm").symlink_to("/etc/passwd")
        (self.folder / "IM9999").write_bytes((self.folder / "IM0003").read_bytes())  # a copy
        scout = s.slice_of(0, rows=30)
        scout.ImageType = ["ORIGINAL", "PRIMARY", "LOCALIZER"]
        s.save(self.folder, scout, "scout")
        warnings = s.info(self.folder)["warnings"]
        for text in ("README.txt is not read: it is no DICOM file", "DICOMDIR is not read", "link.dcm is not read: links",
                     "IM9999 is not read: it is a copy", "scout is not read: it is a localizer"):
            self.assertTrue(any(text in warning for warning in warnings), (text, warnings))
        self.check_values(lambda i, j, k: s.value(i, j, k) - 1024)

    def test_one_of_several_series_is_chosen_by_its_uid(self):
        s.save_all(self.folder, [s.slice_of(k) for k in range(5)])
        other = "1.2.826.0.1.3680043.10.2"
        s.save_all(self.folder, [s.slice_of(k, series=other, intercept=0) for k in range(4)], lambda k: f"b{k}")
        message = s.refusal(self.folder)
        self.assertIn("the folder has 2 series", message)
        self.assertIn(other, message)
        grid, _ = self.read("--series", other)
        self.assertEqual(grid.size[2], 4)
        self.assertEqual(grid[3, 2, 1], s.value(3, 2, 1))

    def test_rle_and_other_transfer_syntaxes_have_the_same_values(self):
        slices = [s.slice_of(k) for k in range(5)]
        slices[1].is_implicit_VR = True
        slices[1].file_meta.TransferSyntaxUID = s.pydicom.uid.ImplicitVRLittleEndian
        slices[2].file_meta.TransferSyntaxUID = s.pydicom.uid.DeflatedExplicitVRLittleEndian
        slices[3] = s.with_rle(slices[3])
        big = slices[4]
        big.PixelData = b"".join(big.PixelData[at:at + 2][::-1] for at in range(0, len(big.PixelData), 2))
        big.is_little_endian = False
        big.file_meta.TransferSyntaxUID = s.pydicom.uid.ExplicitVRBigEndian
        s.save_all(self.folder, slices)
        self.check_values(lambda i, j, k: s.value(i, j, k) - 1024)
        encoding = s.info(self.folder)["encoding"]
        for name in ("implicit", "deflated", "RLE", "big endian"):
            self.assertIn(name, encoding)

    def test_a_long_head_is_read_too(self):
        slices = [s.slice_of(k) for k in range(3)]
        for data in slices:
            data.add_new((0x0009, 0x0010), "LO", "ACME")
            data.add_new((0x0009, 0x1001), "OB", bytes(100_000))
        s.save_all(self.folder, slices)
        self.check_values(lambda i, j, k: s.value(i, j, k) - 1024, slices=3)

    def test_the_same_as_pydicom_reads(self):
        s.save_all(self.folder, [s.slice_of(k, slope=2, intercept=-100) for k in range(5)])
        grid, _ = self.read()
        files = [s.pydicom.dcmread(self.folder / name) for name in s.info(self.folder)["files"]]
        places = [float(data.ImagePositionPatient[2]) for data in files]
        self.assertEqual(places, sorted(places))
        for k, data in enumerate(files):
            stored = s.array.array("H", data.PixelData)
            expected = [data.RescaleSlope * v + data.RescaleIntercept for v in stored]
            self.assertEqual(list(grid.values[k * 192:(k + 1) * 192]), expected)


class Phantom(unittest.TestCase):
    def test_the_volume_of_the_demo_cell_is_what_its_program_makes(self):
        cell = pathlib.Path(s.os.environ["CELLMIRROR_SOURCE_DIR"]) / "config/cells/volume_cell/envlib"
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, "-B", cell / "make_volume.py", "--into", folder], check=True, timeout=100)
            made, _ = s.converted(pathlib.Path(folder) / "phantom.nrrd", pathlib.Path(folder) / "a.nrrd")
            lying, _ = s.converted(cell / "phantom.nrrd", pathlib.Path(folder) / "b.nrrd")
            self.assertEqual(made.fields, lying.fields)
            self.assertEqual(made.values, lying.values)


if __name__ == "__main__":
    unittest.main(verbosity=2)
