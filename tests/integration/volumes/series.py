"""Series of DICOM slices written with pydicom, and what `cellmirror volume` reads of them."""

import array
import json
import os
import pathlib
import struct
import subprocess
import sys
import warnings

try:
    import pydicom
    from pydicom.dataset import Dataset, FileMetaDataset
    from pydicom.encaps import encapsulate
    from pydicom.uid import ExplicitVRLittleEndian, RLELossless, generate_uid
except ImportError:
    print("skipped: python3-pydicom is not installed")
    sys.exit(77)

warnings.filterwarnings("ignore")
BINARIES = pathlib.Path(os.environ["CELLMIRROR_BIN_DIR"])
CT_IMAGE = "1.2.840.10008.5.1.4.1.1.2"


def value(i, j, k):
    """Stored value of a pixel: another one in every voxel of small volumes."""
    return (7 * i + 131 * j + 577 * k) % 4000


def slice_of(k, *, rows=12, columns=16, series="1.2.826.0.1.3680043.10.1", first=(-30.0, -40.0, 100.0), step=(0, 0, 2.5),
             row=(1, 0, 0), column=(0, 1, 0), signed=False, bits=16, stored=12, slope=1, intercept=-1024, pixels=None):
    """Slice k of a series, as a data set that can be changed before it is saved."""
    data = Dataset()
    data.file_meta = FileMetaDataset()
    data.file_meta.MediaStorageSOPClassUID = CT_IMAGE
    data.file_meta.MediaStorageSOPInstanceUID = generate_uid()
    data.file_meta.TransferSyntaxUID = ExplicitVRLittleEndian
    data.is_little_endian, data.is_implicit_VR = True, False
    data.SOPClassUID, data.SOPInstanceUID = CT_IMAGE, data.file_meta.MediaStorageSOPInstanceUID
    data.Modality, data.Manufacturer, data.ManufacturerModelName = "CT", "ACME", "Ring 1"
    data.PatientID, data.PatientName = "77", "Nobody^Ann"
    data.StudyInstanceUID, data.SeriesInstanceUID, data.SeriesDescription = "1.2.3", series, "thin slices"
    data.InstanceNumber = k + 1
    data.ImagePositionPatient = [a + k * s for a, s in zip(first, step)]
    data.ImageOrientationPatient = [*row, *column]
    data.PixelSpacing = [0.7, 0.5]
    data.SliceThickness = 99  # not the distance of the slices
    data.Rows, data.Columns, data.SamplesPerPixel = rows, columns, 1
    data.PhotometricInterpretation = "MONOCHROME2"
    data.BitsAllocated, data.BitsStored, data.HighBit = bits, stored, stored - 1
    data.PixelRepresentation = int(signed)
    if slope is not None:
        data.RescaleSlope, data.RescaleIntercept = slope, intercept
    if pixels is None:
        pixels = [value(i, j, k) - (2000 if signed else 0) for j in range(rows) for i in range(columns)]
    kind = ("b" if signed else "B") if bits == 8 else ("h" if signed else "H")
    data.PixelData = array.array(kind, pixels).tobytes()
    return data


def save(folder, data, name):
    folder.mkdir(parents=True, exist_ok=True)
    data.save_as(folder / name, write_like_original=False)


def save_all(folder, slices, names=lambda k: f"IM{(k * 7 + 3) % 97:04d}"):
    """Names that say nothing about the order."""
    for k, data in enumerate(slices):
        save(folder, data, names(k))


def pack_bits(row):
    """RLE of PS3.5, annex G: literal runs alone."""
    out = b""
    for at in range(0, len(row), 128):
        part = row[at:at + 128]
        out += bytes([len(part) - 1]) + part
    return out + (b"\0" if len(out) % 2 else b"")


def with_rle(data):
    raw = data.PixelData
    planes = [pack_bits(raw[1::2]), pack_bits(raw[0::2])]  # the high bytes first
    offsets = [64, 64 + len(planes[0])] + [0] * 13
    data.PixelData = encapsulate([struct.pack("<16L", 2, *offsets) + b"".join(planes)])
    data["PixelData"].is_undefined_length = True
    data.file_meta.TransferSyntaxUID = RLELossless
    return data


def run(*arguments, timeout=60):
    return subprocess.run([BINARIES / "cellmirror", "volume", *map(str, arguments)], capture_output=True, text=True,
                          timeout=timeout, check=False)


def info(source, *options):
    done = run("info", source, "--json", *options)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def refusal(source, *options):
    done = run("info", source, *options)
    assert done.returncode == 1, done.stdout
    return done.stderr


class Grid:
    """What `volume convert` wrote."""

    def __init__(self, path):
        head, _, data = path.read_bytes().partition(b"\n\n")
        self.fields = dict(line.split(": ", 1) for line in head.decode().splitlines()[2:])
        self.size = [int(n) for n in self.fields["sizes"].split()]
        self.values = array.array({"short": "h", "float": "f"}[self.fields["type"]], data)

    def __getitem__(self, ijk):
        i, j, k = ijk
        return self.values[i + self.size[0] * (j + self.size[1] * k)]


def converted(source, into, *options):
    done = run("convert", source, into, *options)
    assert done.returncode == 0, done.stderr
    return Grid(into), done.stderr
