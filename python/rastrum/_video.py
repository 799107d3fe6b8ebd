# SPDX-License-Identifier: BSD-3-Clause
"""Many pictures in one file: GIF and APNG by PIL, MP4 by ffmpeg, or a PNG each."""

import re
import shutil
import subprocess
import sys

from ._errors import ArgumentError, FileError, UnsupportedError
from ._files import refuse_inputs, whole
from ._render import _numbered

_NUMBERED = re.compile(r"%0?\d*d")


def check(path, size):
    """Throws what write() would, as far as it can be known before a picture is drawn."""
    if _NUMBERED.search(path):
        if not path.lower().endswith(".png"):
            raise ArgumentError(f"{path}: a name with a number must end in .png")
        _numbered(path, 0)
    elif path.lower().endswith(".mp4"):
        if size[0] % 2 or size[1] % 2:
            raise ArgumentError(f"{path}: MP4 needs an even width and height, not {size[0]}x{size[1]}")
        _ffmpeg(path)
    elif path.lower().endswith((".gif", ".png")):
        _pil(path)
    else:
        raise ArgumentError(f"{path}: videos are .mp4, .gif, .png (animated) or frames as in frame_%04d.png")


def write(path, pictures, count, size, fps, read=()):
    """Writes `count` pictures one after the other; each is drawn when its turn comes. read: the files of their scene."""
    check(path, size)
    names = [_numbered(path, i) for i in range(count)] if _NUMBERED.search(path) else [path]
    for name in names:
        refuse_inputs(name, read)
    if _NUMBERED.search(path):
        for name, picture in zip(names, pictures):
            picture.save(name)
        return
    with whole(path) as file:
        if path.lower().endswith(".mp4"):
            _mp4(path, file, pictures, size, fps)
        else:
            frames = [_pil(path).fromarray(p.color) for p in pictures]
            frames[0].save(file, "gif" if path.lower().endswith(".gif") else "png", save_all=True, append_images=frames[1:],
                           duration=round(1000 / fps), loop=0)


def _pil(path):
    try:
        from PIL import Image
    except ImportError as e:
        raise UnsupportedError(f"{path}: needs PIL to be written, which is not installed (pip install pillow)") from e
    return Image


def _ffmpeg(path):
    if sys.platform == "win32":  # no child can write to an open file there
        raise UnsupportedError(f"{path}: an .mp4 is not written on Windows: write numbered pictures, as in frame_%04d.png")
    found = shutil.which("ffmpeg")
    if found is None:
        try:
            import imageio_ffmpeg
            found = imageio_ffmpeg.get_ffmpeg_exe()
        except (ImportError, RuntimeError) as e:
            raise UnsupportedError(f"{path}: needs ffmpeg to be written, which is not here (pip install imageio-ffmpeg)") from e
    return found


def _mp4(path, file, pictures, size, fps):
    # ffmpeg writes to the open file, as in the program.
    command = [_ffmpeg(path), "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgba", "-s", f"{size[0]}x{size[1]}",
               "-r", str(fps), "-i", "-", "-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mp4", f"file:/dev/fd/{file.descriptor}"]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE, pass_fds=[file.descriptor]) as encoder:
        try:
            for picture in pictures:
                encoder.stdin.write(picture.color.tobytes())
            encoder.stdin.close()
        except BrokenPipeError:
            pass  # it says why
        except BaseException:
            encoder.kill()
            raise
        said = encoder.stderr.read().decode(errors="replace").strip()
    if encoder.returncode != 0:
        raise FileError(f"{path}: cannot be written: ffmpeg: {said or f'it ended with status {encoder.returncode}'}")
