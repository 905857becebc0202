#!/usr/bin/env python3
"""Has Drake (PyPI's package drake) render its kinds of images by candela, and compares them with those of Drake's own
renderer, VTK: depths and labels pixel by pixel, where both see the same shape at the pixel and around it.

The shapes are those of Drake's example of RenderEngineGltfClient: boxes, capsules, cylinders, ellipsoids and spheres.
Needs a Python with drake, and one with NumPy for the server; the program is found as by the package `candela`.
usage: PYTHON_WITH_DRAKE tests/bench/drake_client.py CANDELA [FOLDER]      FOLDER gets the colour images, as PPM."""
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy
from pydrake.geometry import (Box, Capsule, ClippingRange, ColorRenderCamera, Cylinder, DepthRange, DepthRenderCamera,
                              Ellipsoid, GeometryInstance, MakeRenderEngineGltfClient,
                              MakeRenderEngineVtk, PerceptionProperties, RenderCameraCore,
                              RenderEngineGltfClientParams, RenderEngineVtkParams, RenderLabel, Rgba, SceneGraph,
                              Sphere)
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.sensors import CameraInfo, RgbdSensor

ROOT = Path(__file__).resolve().parents[2]
SHAPES = (Box(0.1, 0.075, 0.05), Capsule(0.05, 0.1), Cylinder(0.05, 0.1), Ellipsoid(0.05, 0.025, 0.0375), Sphere(0.05))
COLOURS = ((1, 0.25, 0.25), (1, 1, 0.25), (0.25, 1, 0.25), (0.25, 1, 1), (0.25, 0.25, 1))
SIZE = (320, 240)
# Both see the same triangles, but VTK has depths of 24 bits.
DEPTH_TOLERANCE = 1e-3  # As Drake's own test [m].


def images(engine):
    """The colour, depth and label images of the shapes, with a principal point off the middle."""
    builder = DiagramBuilder()
    graph = builder.AddSystem(SceneGraph())
    graph.AddRenderer("renderer", engine)
    source = graph.RegisterSource("shapes")
    for side in (0, 1):
        for index, (shape, colour) in enumerate(zip(SHAPES, COLOURS)):
            pose = RigidTransform(RollPitchYaw(0.3 * index, 0.2, 0.1), [0.4 - 0.15 * index, 0.5 * side - 0.25, 0])
            geometry = GeometryInstance(pose, shape, f"shape {side} {index}")
            properties = PerceptionProperties()
            properties.AddProperty("phong", "diffuse", Rgba(*colour, 1))
            properties.AddProperty("label", "id", RenderLabel(300 * side + index + 1))
            geometry.set_perception_properties(properties)
            graph.RegisterAnchoredGeometry(source, geometry)
    info = CameraInfo(*SIZE, focal_x=260, focal_y=260, center_x=170.25, center_y=110.75)
    core = RenderCameraCore("renderer", info, ClippingRange(0.01, 10), RigidTransform())
    sensor = builder.AddSystem(RgbdSensor(graph.world_frame_id(), RigidTransform(RollPitchYaw(-2.2, 0, 1.57), [0.8, 0,
                                                                                                               0.5]),
                                          ColorRenderCamera(core), DepthRenderCamera(core, DepthRange(0.1, 5))))
    builder.Connect(graph.get_query_output_port(), sensor.query_object_input_port())
    diagram = builder.Build()
    context = sensor.GetMyContextFromRoot(diagram.CreateDefaultContext())
    return [numpy.array(port.Eval(context).data).squeeze() for port in (
        sensor.color_image_output_port(), sensor.depth_image_32F_output_port(), sensor.label_image_output_port())]


def even(labels):
    """Whether a pixel and the eight around it show the same."""
    same = numpy.ones(labels.shape, bool)
    for y in (-1, 0, 1):
        for x in (-1, 0, 1):
            same &= numpy.roll(labels, (y, x), (0, 1)) == labels
    return same


def main():
    """Prints what was compared; exits 1 if anything differs."""
    program, folder = os.path.abspath(sys.argv[1]), Path(sys.argv[2] if len(sys.argv) > 2 else ".")
    environment = {**os.environ, "CANDELA": program, "PYTHONPATH": str(ROOT / "integrations/python")}
    server = subprocess.Popen([sys.executable, "-m", "candela.serve", "--port", "0"],
                              env=environment, stdout=subprocess.PIPE, text=True)
    try:
        address = server.stdout.readline().split()[1].rsplit("/", 1)[0]
        began = time.monotonic()
        color, depth, label = images(MakeRenderEngineGltfClient(RenderEngineGltfClientParams(
            base_url=address, render_endpoint="render?spp=16")))
        print(f"candela: colour, depth and label images of {SIZE[0]}x{SIZE[1]} in {time.monotonic() - began:.2f} s")
    finally:
        server.terminate()
        server.wait()
    vtk_color, vtk_depth, vtk_label = images(MakeRenderEngineVtk(RenderEngineVtkParams()))
    for name, image in (("candela", color), ("vtk", vtk_color)):
        (folder / f"{name}.ppm").write_bytes(b"P6 %d %d 255\n" % SIZE + numpy.ascontiguousarray(image[:, :,
                                                                                                      :3]).tobytes())
    vtk_label = numpy.where(vtk_label == int(RenderLabel.kEmpty), int(RenderLabel.kDontCare), vtk_label)
    inside = even(label) & even(vtk_label)
    print(f"labels: {sorted({int(value) for value in numpy.unique(label)})}")
    wrong = (label != vtk_label) & inside
    shown = inside & (label == vtk_label) & (label != int(RenderLabel.kDontCare))
    difference = abs(depth[shown] - vtk_depth[shown])
    nothing = numpy.isinf(depth[inside & ~shown]).all() and numpy.isinf(vtk_depth[inside & ~shown]).all()
    print(f"{inside.sum()} pixels away from edges: {wrong.sum()} other labels")
    print(f"{shown.sum()} of them on shapes: depths differ by at most {difference.max():.2g} m, on average by "
          f"{difference.mean():.2g} m; at others, both are infinite: {nothing}")
    print(f"at edges, {(label != vtk_label).sum()} of {(~inside).sum()} labels differ")
    return int(wrong.any() or difference.max() > DEPTH_TOLERANCE or not nothing or len(numpy.unique(label)) != 11)


sys.exit(main())
