#!/usr/bin/python3
"""Draws speed against error of one mesh: the engines at all qualities, and ray tracing.

    speed_and_error.py MESH PICTURE
"""
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import surfelao


def main():
    mesh = surfelao.read(sys.argv[1])
    told = surfelao.compare(mesh.vertices, mesh.faces, normals=mesh.normals,
                            normal_faces=mesh.normal_faces)
    figure, axes = plt.subplots(figsize=(7, 5))
    for engine, marker in (("masks", "o"), ("disks", "s"), ("rays", "^")):
        rows = [row for row in told["rows"] if row["engine"] == engine]
        rows.sort(key=lambda row: row["beyond"])
        seconds = [row["build_s"] + row["solve_s"] + row["fit_s"] for row in rows]
        axes.loglog(seconds, [row["beyond"] for row in rows], marker=marker, label=engine)
        for row, time in zip(rows, seconds):
            axes.annotate(row["setting"], (time, row["beyond"]), xytext=(4, 4),
                          textcoords="offset points", fontsize=7)
    axes.set_xlabel("seconds: build, solve and fit")
    axes.set_ylabel(f"RMS error beyond the floor of {told['floor']['rmse']:.4f}")
    axes.margins(0.12)  # room for the words at the last points
    axes.set_title(f"{mesh.name}: {told['vertices']} vertices, {told['threads']} threads")
    axes.grid(True, which="both", alpha=0.3)
    axes.legend()
    figure.tight_layout()
    figure.savefig(sys.argv[2], dpi=150)


if __name__ == "__main__":
    main()
