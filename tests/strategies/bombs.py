"""Archives of many equal members, which are packed once: a bomb takes no longer than one of its members."""

from __future__ import annotations

import io
import struct
import zipfile


def repeated(content: bytes, members: int) -> bytes:
    """A zip file of `members` (up to 100) named x00.npy, x01.npy, ..., each with this content."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("x00.npy", content)
    whole = stream.getvalue()
    local, listed = whole[: archive.start_dir], whole[archive.start_dir : -22]
    names = [f"x{i:02d}.npy".encode() for i in range(members)]
    files = b"".join(local.replace(b"x00.npy", name, 1) for name in names)
    directory = b"".join(
        listed[:42] + struct.pack("<L", i * len(local)) + listed[46:].replace(b"x00.npy", name, 1)
        for i, name in enumerate(names)
    )
    end = struct.pack("<4s4H2LH", b"PK\5\6", 0, 0, members, members, len(directory), len(files), 0)
    return files + directory + end
