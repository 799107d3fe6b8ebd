# SPDX-License-Identifier: BSD-3-Clause
"""python -m rastrum render|views|video|info FILE...: pictures of files, without the program."""

import argparse
import sys

from . import ArgumentError, Camera, Error, Scene, _video, orbit, render, views4


def _size(text):
    width, _, height = text.partition("x")
    return int(width), int(height)


def _range(text):
    low, _, high = text.partition(",")
    return float(low), float(high)


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="python -m rastrum", description="Pictures of meshes and point clouds.",
                                     epilog="example: python -m rastrum views part.stl -o views.png")
    commands = parser.add_subparsers(dest="command", required=True)
    for name, about in (("render", "one picture"), ("views", "front, right, top and three-quarter view"), ("video", "a turn around the files"),
                        ("info", "what is in the files")):
        command = commands.add_parser(name, help=about, description=about)
        command.add_argument("files", nargs="+", metavar="FILE",
                             help=".obj .ply .stl .off .gltf .glb .npy, and the files that vtk, meshio and trimesh read")
        if name != "info":
            command.add_argument("-o", "--output", required=True,
                                 help=".mp4, .gif, .png (animated) or frame_%%04d.png" if name == "video" else ".png")
            command.add_argument("--size", type=_size, default=(1280, 720) if name != "views" else (512, 512),
                                 help="size of the picture in pixels, WxH")
            command.add_argument("--shader", default="auto",
                                 help="a shader; auto (the default): a picture to show, with studio lights, occlusion and four samples")
            command.add_argument("--background", default=None, help="#rrggbb or a name (default: transparent)")
            command.add_argument("--scalars", metavar="NAME",
                                 help="colour by these numbers of the files (info lists their names), or by x, y, z or distance")
            command.add_argument("--cmap", default="viridis", metavar="NAME", help="colours of --scalars (default: viridis)")
            command.add_argument("--range", type=_range, metavar="LOW,HIGH",
                                 help="numbers of the first and the last colour (default: the least and the greatest)")
        if name == "render":
            command.add_argument("--view", default="iso", help="front, back, left, right, top, bottom, iso (default: iso)")
        if name == "video":
            command.add_argument("--frames", type=int, default=72, help="pictures of the whole turn (default: 72)")
            command.add_argument("--fps", type=float, default=24.0, help="pictures a second (default: 24)")
            command.add_argument("--elevation", type=float, default=25.0, help="degrees from which the camera looks down (default: 25)")
    arguments = list(sys.argv[1:] if arguments is None else arguments)
    if "--range" in arguments[:-1]:  # or argparse takes -5,5 for an option
        at = arguments.index("--range")
        arguments[at:at + 2] = [f"--range={arguments[at + 1]}"]
    options = parser.parse_args(arguments)
    try:
        numbers = {}
        if getattr(options, "scalars", None) is not None:
            numbers = {"scalars": options.scalars, "cmap": options.cmap, "clim": options.range}
        scene = Scene(options.files, **numbers)
        for warning in scene.warnings:
            print(f"note: {warning}", file=sys.stderr)
        if options.command == "info":
            print(scene._made.describe(), end="")
            return 0
        look = {"size": options.size, "shader": options.shader, "background": options.background}
        notes = {}
        if numbers and options.command != "views":  # where it would be there four times
            notes["bar"] = options.scalars
        if options.shader == "auto":  # as the program alone
            look |= {"lights": "studio", "samples": 4}
            notes["occlusion"] = True
        look["annotate"] = notes
        if options.command == "video":
            if options.frames < 1 or not 0 < options.fps <= 1000:
                raise ArgumentError("--frames, --fps: must be greater than 0")
            cameras = orbit(scene, options.frames, elevation=options.elevation)
            _video.write(options.output, (render(scene, c, **look) for c in cameras), options.frames, options.size, options.fps,
                         scene._read_from)
            return 0
        if options.command == "views":
            picture = views4(scene, **look)
        else:
            picture = render(scene, Camera.fit(scene, options.view, fov=30), **look)
        picture.save(options.output)
    except Error as e:
        print(f"error: {e}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
