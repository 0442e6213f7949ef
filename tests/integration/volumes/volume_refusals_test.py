"""What is wrong with a volume is said by name, and whatever is in its files, the program ends in order."""

import os
import pathlib
import random
import tempfile
import unittest
import zlib

import series as s


class Refused(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.temporary.name)
        self.folder = self.root / "ct"

    def tearDown(self):
        self.temporary.cleanup()

    def why(self, slices):
        s.save_all(self.folder, slices, lambda k: f"im{k}")
        return s.refusal(self.folder)

    def test_a_missing_slice(self):
        message = self.why([s.slice_of(k) for k in (0, 1, 2, 5, 6, 7)])
        self.assertIn("slices are missing between im2 (105.000 mm) and im3 (112.500 mm): about 2", message)

    def test_an_uneven_slice(self):
        slices = [s.slice_of(k) for k in range(6)]
        slices[3].ImagePositionPatient[2] += 0.6
        self.assertIn("the distance between im2", self.why(slices))

    def test_two_slices_at_a_place(self):
        slices = [s.slice_of(k) for k in range(6)] + [s.slice_of(3)]
        message = self.why(slices)
        self.assertIn("are at the same place", message)
        self.assertIn("im3", message)
        self.assertIn("im6", message)

    def test_two_patients_whom_it_does_not_name(self):
        slices = [s.slice_of(k) for k in range(4)]
        slices[2].PatientID, slices[2].PatientName = "88", "Other^Bob"
        message = self.why(slices)
        self.assertIn("im0 and im2 are of different patients", message)
        self.assertNotIn("Bob", message)
        self.assertNotIn("88", message.replace(str(self.root), ""))

    def test_slices_of_several_sizes(self):
        message = self.why([s.slice_of(0), s.slice_of(1), s.slice_of(2, rows=13)])
        self.assertIn("im2: it has 16 x 13 pixels, im0 has 16 x 12", message)

    def test_pixel_data_that_are_too_short(self):
        slices = [s.slice_of(k) for k in range(4)]
        slices[2].PixelData = slices[2].PixelData[:100]
        self.assertIn("im2: ", self.why(slices))

    def test_a_file_that_ends_early(self):
        s.save_all(self.folder, [s.slice_of(k) for k in range(4)], lambda k: f"im{k}")
        whole = (self.folder / "im1").read_bytes()
        (self.folder / "im1").write_bytes(whole[:-50])
        self.assertIn("im1: ", s.refusal(self.folder))

    def test_slices_without_places(self):
        slices = [s.slice_of(k) for k in range(4)]
        del slices[1].ImagePositionPatient
        self.assertIn("im1: it has no position and orientation", self.why(slices))

    def test_colours_and_several_frames(self):
        slices = [s.slice_of(k) for k in range(3)]
        slices[0].PhotometricInterpretation = "PALETTE COLOR"
        self.assertIn("im0: its pixels are PALETTE COLOR", self.why(slices))
        slices[0].PhotometricInterpretation = "MONOCHROME2"
        slices[1].NumberOfFrames = 120
        self.assertIn("im1: it has 120 frames", self.why(slices))

    def test_a_pixel_size_that_needs_more_than_there_is(self):
        slices = [s.slice_of(k) for k in range(3)]
        for data in slices:
            data.Rows, data.Columns = 60000, 60000
        message = self.why(slices)
        self.assertIn("60000", message)

    def test_a_bomb_of_a_transfer_syntax(self):
        # A deflated data set of a kilobyte that would be a gigabyte of a private attribute.
        data = s.slice_of(0)
        data.file_meta.TransferSyntaxUID = s.pydicom.uid.DeflatedExplicitVRLittleEndian
        s.save_all(self.folder, [data, s.slice_of(1), s.slice_of(2)], lambda k: f"im{k}")
        whole = (self.folder / "im0").read_bytes()
        head = whole[:132]
        # The meta information ends where its length says: group length at 132, 12 bytes.
        length = int.from_bytes(whole[140:144], "little")
        meta = whole[132:144 + length]
        packer = zlib.compressobj(9, zlib.DEFLATED, -zlib.MAX_WBITS)
        size = 3 << 30
        bomb = packer.compress(b"\x09\x00\x10\x00OB\0\0" + size.to_bytes(4, "little")) + packer.flush(zlib.Z_FULL_FLUSH)
        # After a full flush the same bytes are packed as the same bytes again: packed once, and repeated.
        zeros = packer.compress(bytes(1 << 24)) + packer.flush(zlib.Z_FULL_FLUSH)
        bomb += zeros * (size >> 24) + packer.flush()
        (self.folder / "im0").write_bytes(head + meta + bomb)
        before = os.times()
        done = s.run("info", self.folder)
        self.assertEqual(done.returncode in (0, 1), True)
        self.assertNotIn("Traceback", done.stderr)
        # It is refused by name, or left out as what is no DICOM file.
        self.assertIn("im0", done.stderr + done.stdout)
        self.assertLess(os.times().children_user - before.children_user, 60)

    def test_a_folder_of_tens_of_thousands_of_files(self):
        self.folder.mkdir()
        for i in range(9000):
            (self.folder / f"{i}").touch()
        self.assertIn("more than 8192 entries", s.refusal(self.folder))

    def test_damaged_files_of_every_kind_end_in_order(self):
        random_bytes = random.Random(17)
        whole = []
        for make in (lambda: s.slice_of(0), lambda: s.with_rle(s.slice_of(0))):
            s.save(self.root / "one", make(), "a")
            whole.append((self.root / "one/a").read_bytes())
        s.save_all(self.folder, [s.slice_of(k) for k in range(1, 3)], lambda k: f"good{k}")
        for i in range(30):
            bytes_of_file = bytearray(whole[i % 2])
            for _ in range(random_bytes.randint(1, 8)):
                bytes_of_file[random_bytes.randrange(132, len(bytes_of_file))] = random_bytes.randrange(256)
            (self.folder / "bad").write_bytes(bytes_of_file[:random_bytes.randint(140, len(bytes_of_file))])
            done = s.run("info", self.folder)
            self.assertIn(done.returncode, (0, 1), (i, done))

    def test_a_pipe_in_place_of_a_file(self):
        self.folder.mkdir()
        os.mkfifo(self.folder / "pipe.nrrd")
        self.assertIn("is no regular file", s.refusal(self.folder / "pipe.nrrd"))

    def test_a_cell_names_the_line_of_its_volume(self):
        home = self.root / "cell"
        (home / "envlib").mkdir(parents=True)
        (home / "cell.toml").write_text('format = 1\nname = "c"\n[[node]]\nname = "N"\nabstract = "n.mpc"\n')
        (home / "envlib/n.mpc").write_text('format = 1\n[volume]\nsource = "ct"\n')
        self.folder = home / "envlib/ct"
        s.save_all(self.folder, [s.slice_of(k) for k in (0, 1, 4)])
        done = s.subprocess.run([s.BINARIES / "cellmirror", "check", home / "cell.toml"], capture_output=True, text=True,
                                timeout=60, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr + done.stdout, r"n\.mpc:3:10: error: the volume ct: slices are missing")


if __name__ == "__main__":
    unittest.main(verbosity=2)
