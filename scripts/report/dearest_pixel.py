"""The pixel with the largest value of a plane that nuvo --planes wrote, as x,y."""

import array
import ast
import pathlib
import sys


def plane(path):
    """Shape and values of a .npy file of version 1 with uint32."""
    data = pathlib.Path(path).read_bytes()
    size = int.from_bytes(data[8:10], "little")
    header = ast.literal_eval(data[10:10 + size].decode("ascii"))
    if header["descr"] != "<u4" or array.array("I").itemsize != 4:
        sys.exit(f"{path}: {header['descr']} where <u4 was expected")
    return header["shape"], array.array("I", data[10 + size:])


if __name__ == "__main__":
    (_, width), values = plane(sys.argv[1])
    place = max(range(len(values)), key=values.__getitem__)
    print(f"{place % width},{place // width}")
