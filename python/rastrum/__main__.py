"""python -m rastrum render|views|info FILE...: pictures of files, without the program."""

import argparse
import sys

from . import Camera, Error, Scene, render, views4


def _size(text):
    width, _, height = text.partition("x")
    return int(width), int(height)


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="python -m rastrum", description="Pictures of meshes and point clouds.",
                                     epilog="example: python -m rastrum views part.stl -o views.png")
    commands = parser.add_subparsers(dest="command", required=True)
    for name, about in (("render", "one picture"), ("views", "front, right, top and three-quarter view"),
                        ("info", "what is in the files")):
        command = commands.add_parser(name, help=about, description=about)
        command.add_argument("files", nargs="+", metavar="FILE", help=".obj .ply .stl .off .gltf .glb")
        if name != "info":
            command.add_argument("-o", "--output", required=True, help=".png")
            command.add_argument("--size", type=_size, default=(1280, 720) if name == "render" else (512, 512),
                                 help="WxH")
            command.add_argument("--shader", default="auto")
            command.add_argument("--background", default=None, help="#rrggbb or a name (transparent)")
        if name == "render":
            command.add_argument("--view", default="front", help="front, back, left, right, top, bottom, iso")
    options = parser.parse_args(arguments)
    try:
        scene = Scene(options.files)
        for warning in scene.warnings:
            print(f"note: {warning}", file=sys.stderr)
        if options.command == "info":
            print(scene._made.describe(), end="")
            return 0
        look = {"size": options.size, "shader": options.shader, "background": options.background}
        if options.command == "views":
            picture = views4(scene, **look)
        else:
            picture = render(scene, Camera.fit(scene, options.view), **look)
        picture.save(options.output)
    except Error as e:
        print(f"error: {e}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
