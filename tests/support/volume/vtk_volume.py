"""Draws a volume with VTK's vtkFixedPointVolumeRayCastMapper (Debian: python3-vtk9), for comparison.

Argument: a folder with job.json, voxels.raw (x fastest) and table.raw (rows of float32: value, red, green, blue, extinction
a metre). Writes picture.raw (RGB on black, rows from the top) and times.json. Needs an X server: run it by xvfb-run."""

import json
import sys
import time
from pathlib import Path

import numpy
import vtk
from vtk.util import numpy_support

TYPES = {"u8": numpy.uint8, "i16": numpy.int16, "u16": numpy.uint16}


def image_of(folder: Path, job: dict) -> vtk.vtkImageData:
    voxels = numpy.fromfile(folder / "voxels.raw", dtype=TYPES[job["type"]])
    image = vtk.vtkImageData()
    image.SetDimensions(job["size"])
    image.SetSpacing(job["spacing_m"])
    image.SetOrigin([-0.5 * (n - 1) * s for n, s in zip(job["size"], job["spacing_m"])])
    array = numpy_support.numpy_to_vtk(voxels, deep=True)
    image.GetPointData().SetScalars(array)
    return image


def property_of(folder: Path, job: dict) -> vtk.vtkVolumeProperty:
    """Opacity is given for a unit distance of one step, so that VTK has nothing to convert."""
    rows = numpy.fromfile(folder / "table.raw", dtype=numpy.float32).reshape(-1, 5).astype(float)
    colour = vtk.vtkColorTransferFunction()
    opacity = vtk.vtkPiecewiseFunction()
    for value, red, green, blue, extinction in rows:
        colour.AddRGBPoint(value, red, green, blue)
        opacity.AddPoint(value, 1 - numpy.exp(-extinction * job["step_m"]))
    made = vtk.vtkVolumeProperty()
    made.SetColor(colour)
    made.SetScalarOpacity(opacity)
    made.SetScalarOpacityUnitDistance(job["step_m"])
    made.SetInterpolationTypeToLinear()
    if job.get("shade"):
        made.ShadeOn()
        made.SetAmbient(0.3)
        made.SetDiffuse(0.7)
        made.SetSpecular(0.18)
        made.SetSpecularPower(32)
    else:
        made.ShadeOff()
    return made


def camera_of(job: dict, camera: vtk.vtkCamera) -> None:
    camera.SetPosition(job["from"])
    camera.SetFocalPoint(job["to"])
    camera.SetViewUp(job["up"])
    camera.SetClippingRange(job["near_m"], job["far_m"])
    if job["height_m"] > 0:
        camera.ParallelProjectionOn()
        camera.SetParallelScale(job["height_m"] / 2)
    else:
        camera.SetViewAngle(numpy.degrees(job["opening_angle"]))


def main() -> int:
    folder = Path(sys.argv[1])
    job = json.loads((folder / "job.json").read_text())
    mapper = vtk.vtkFixedPointVolumeRayCastMapper()
    mapper.SetInputData(image_of(folder, job))
    mapper.SetAutoAdjustSampleDistances(0)
    mapper.SetImageSampleDistance(1)
    mapper.SetInteractiveSampleDistance(job["step_m"])
    mapper.SetSampleDistance(job["step_m"])
    mapper.SetMaximumImageSampleDistance(1)
    mapper.SetNumberOfThreads(job.get("threads", 1))
    volume = vtk.vtkVolume()
    volume.SetMapper(mapper)
    volume.SetProperty(property_of(folder, job))
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(0, 0, 0)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(job["width"], job["height"])
    window.AddRenderer(renderer)
    camera_of(job, renderer.GetActiveCamera())
    window.Render()
    times = {"empty_s": [], "wall_s": [], "cpu_s": []}
    for _ in range(3):
        begun = time.perf_counter()
        window.Render()
        times["empty_s"].append(time.perf_counter() - begun)
    renderer.AddVolume(volume)
    renderer.GetActiveCamera().SetClippingRange(job["near_m"], job["far_m"])
    window.Render()  # makes its gradients and tables
    for _ in range(job.get("repeats", 1)):
        mapper.Modified()
        wall, cpu = time.perf_counter(), time.process_time()
        window.Render()
        times["wall_s"].append(time.perf_counter() - wall)
        times["cpu_s"].append(time.process_time() - cpu)
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.Update()
    shot = grab.GetOutput()
    pixels = numpy_support.vtk_to_numpy(shot.GetPointData().GetScalars()).reshape(job["height"], job["width"], 3)
    numpy.ascontiguousarray(pixels[::-1]).tofile(folder / "picture.raw")
    (folder / "times.json").write_text(json.dumps(times))
    return 0


if __name__ == "__main__":
    sys.exit(main())
