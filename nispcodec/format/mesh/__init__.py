"""Mesh parts as the content of the section MESH."""

from nispcodec.format.mesh.section import decode, encode

__all__ = ["decode", "encode"]
