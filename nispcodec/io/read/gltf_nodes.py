"""The nodes of a glTF scene: where each mesh stands, how often, and how its skin places it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import Float64Array, Int64Array
from nispcodec.core.counted import counted
from nispcodec.io.read.gltf_buffers import Buffers
from nispcodec.io.read.gltf_json import Element

_INSTANCING = "EXT_mesh_gpu_instancing"
_VISIBILITY = "KHR_node_visibility"
# A count costs a file nothing.
MOST_INSTANCES = 100_000


@dataclass(frozen=True)
class Shown:
    """A node that shows a mesh.

    mesh      the mesh's object in the file
    matrices  (k, 4, 4): from the mesh to the world, one for each instance
    skin      (j, 4, 4): from the mesh in its bind pose to the world by each joint, None without
    weights   of the morph targets
    """

    mesh: Element
    matrices: Float64Array
    skin: Float64Array | None
    weights: tuple[float, ...]


def shown_meshes(root: Element, buffers: Buffers, warnings: list[str]) -> Iterator[Shown]:
    """Each node of the default scene that shows a mesh, depth first; hidden ones are left out.

    Raises MeshError, naming the JSON path, for nodes that are no trees and malformed transforms.
    """
    world = _Worlds(root)
    scene = _scene(root)
    roots = _root_nodes(root, scene)
    stack = list(reversed(roots))
    seen: set[int] = set()
    hidden = 0
    while stack:
        index = stack.pop()
        node = root.entry("nodes", index)
        if index in seen:
            node.fail("a node with one parent", "several, or a cycle")
        seen.add(index)
        if _is_hidden(node):
            hidden += 1
            continue
        mesh = node.optional("mesh")
        if mesh is not None:
            yield _shown(root, buffers, world, node, index)
        stack.extend(reversed(_indices(node, "children")))
    if hidden:
        warnings.append(f"{root.file}: left out {hidden} node(s) of visibility false")
    others = _meshes_outside(root, roots)
    if others:
        warnings.append(
            f"{root.file}: left out {counted(others, 'node')} with a mesh that scene {scene}, "
            f"which is shown, does not have"
        )


def _shown(root: Element, buffers: Buffers, world: _Worlds, node: Element, index: int) -> Shown:
    mesh = root.entry("meshes", node.integer("mesh"))
    weights = (node if node.get("weights") is not None else mesh).numbers_of_any_count("weights")
    if node.get("skin") is not None:
        # A skin replaces the transform of its node.
        skin = root.entry("skins", node.integer("skin"))
        return Shown(mesh, np.eye(4)[None], world.of_joints(skin, buffers), weights)
    matrix = world.matrix(index)
    instancing = node.extension(_INSTANCING)
    if instancing is None:
        return Shown(mesh, matrix[None], None, weights)
    instances = _instance_matrices(root, instancing.need("attributes"), buffers)
    return Shown(mesh, matrix @ instances, None, weights)


def _is_hidden(node: Element) -> bool:
    visibility = node.extension(_VISIBILITY)
    return (
        visibility is not None
        and visibility.get("visible") is not None
        and (not visibility.flag("visible"))
    )


def _instance_matrices(root: Element, attributes: Element, buffers: Buffers) -> Float64Array:
    """(k, 4, 4) from TRANSLATION, ROTATION and SCALE, of which any may be missing."""
    read: dict[str, Float64Array] = {}
    for key, width in (("TRANSLATION", 3), ("ROTATION", 4), ("SCALE", 3)):
        accessor = attributes.optional(key)
        if accessor is None:
            continue
        stated = root.entry("accessors", accessor).integer("count")
        if stated > MOST_INSTANCES:
            attributes.fail(f"at most {MOST_INSTANCES} instances", stated)
        read[key] = buffers.numbers(accessor, width)
    counts = {len(values) for values in read.values()}
    if len(counts) != 1:
        attributes.fail("as many instances in each attribute", sorted(counts))
    (count,) = counts
    matrices = np.tile(np.eye(4), (count, 1, 1))
    if "ROTATION" in read:
        matrices[:, :3, :3] = _rotations(read["ROTATION"])
    if "SCALE" in read:
        matrices[:, :3, :3] *= read["SCALE"][:, None, :]
    if "TRANSLATION" in read:
        matrices[:, :3, 3] = read["TRANSLATION"]
    return matrices


class _Worlds:
    """The world matrices (4, 4) of nodes, each made once."""

    def __init__(self, root: Element) -> None:
        self._root = root
        self._parents = {
            child: index
            for index, node in enumerate(root.entries("nodes"))
            for child in _indices(node, "children")
        }
        self._made: dict[int, Float64Array] = {}
        self._skins: dict[str, Float64Array] = {}

    def of_joints(self, skin: Element, buffers: Buffers) -> Float64Array:
        """(j, 4, 4): world transform of each joint times its inverse bind matrix."""
        if skin.path not in self._skins:
            self._skins[skin.path] = self._of_joints(skin, buffers)
        return self._skins[skin.path]

    def _of_joints(self, skin: Element, buffers: Buffers) -> Float64Array:
        joints = _indices(skin, "joints")
        matrices = np.array([self.matrix(joint) for joint in joints]).reshape(-1, 4, 4)
        inverse = skin.optional("inverseBindMatrices")
        if inverse is None:
            return matrices
        columns = buffers.numbers(inverse, 16)
        if len(columns) < len(joints):
            skin.fail(f"{len(joints)} inverse bind matrices", len(columns))
        bound: Float64Array = matrices @ columns[: len(joints)].reshape(-1, 4, 4).transpose(0, 2, 1)
        return bound

    def matrix(self, index: int) -> Float64Array:
        """That of node `index`. Raises MeshError for a node that is its own ancestor."""
        path = [index]
        while path[-1] in self._parents and path[-1] not in self._made:
            path.append(self._parents[path[-1]])
            if len(path) > len(self._parents) + 1:
                self._root.entry("nodes", index).fail("a node with one parent", "a cycle")
        matrix = np.eye(4)
        for each in reversed(path):
            if each not in self._made:
                self._made[each] = matrix @ _local_matrix(self._root.entry("nodes", each))
            matrix = self._made[each]
        return matrix


def _scene(root: Element) -> int:
    """The scene that is shown: the file's default one, else the first that has nodes."""
    default = root.optional("scene")
    if default is not None:
        return default
    scenes = enumerate(root.entries("scenes"))
    return next((index for index, scene in scenes if _indices(scene, "nodes")), 0)


def _meshes_outside(root: Element, roots: list[int]) -> int:
    """How many nodes with a mesh are no descendants of these nodes."""
    nodes, inside, stack = root.entries("nodes"), set[int](), list(roots)
    while stack:
        index = stack.pop()
        if index not in inside and 0 <= index < len(nodes):
            inside.add(index)
            stack.extend(_indices(nodes[index], "children"))
    return sum(node.get("mesh") is not None for at, node in enumerate(nodes) if at not in inside)


def _root_nodes(root: Element, scene: int) -> list[int]:
    if root.entries("scenes"):
        return _indices(root.entry("scenes", scene), "nodes")
    nodes = root.entries("nodes")
    children = {child for node in nodes for child in _indices(node, "children")}
    return [index for index in range(len(nodes)) if index not in children]


def _indices(owner: Element, key: str) -> list[int]:
    array = owner.get(key)
    values = [] if array is None else array.value
    if not isinstance(values, list) or not all(type(value) is int for value in values):
        owner.fail(f"node indices in {key}", values)
    return values


def _local_matrix(node: Element) -> Float64Array:
    if node.get("matrix") is not None:
        flat = node.numbers("matrix", np.eye(4).reshape(-1).tolist())
        return np.array(flat).reshape(4, 4).T
    turn = np.array([node.numbers("rotation", (0.0, 0.0, 0.0, 1.0))])
    matrix = np.eye(4)
    matrix[:3, :3] = _rotations(turn)[0] * node.numbers("scale", (1.0, 1.0, 1.0))
    matrix[:3, 3] = node.numbers("translation", (0.0, 0.0, 0.0))
    return matrix


def _rotations(quaternions: Float64Array) -> Float64Array:
    """(k, 4) as x, y, z, w -> (k, 3, 3); exporters round, so they need not have length one."""
    lengths = np.linalg.norm(quaternions, axis=1, keepdims=True)
    x, y, z, w = (quaternions / np.where(lengths > 0, lengths, 1.0)).T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.array(rows).transpose(2, 0, 1)


def skinned(
    positions: Float64Array, matrices: Float64Array, joints: Int64Array, weights: Float64Array
) -> Float64Array:
    """Positions (n, 3) placed by the joints (n, k) with their weights (n, k); glTF 2.0, 3.7.3.

    matrices (j, 4, 4). Weights are taken relative to their sum; a vertex without any stays.
    """
    total = weights.sum(axis=1, keepdims=True)
    placed = np.zeros_like(positions)
    for column in range(joints.shape[1]):
        chosen = matrices[joints[:, column]]
        moved = np.einsum("nij,nj->ni", chosen[:, :3, :3], positions) + chosen[:, :3, 3]
        placed += weights[:, column, None] * moved
    return np.where(total > 0, placed / np.where(total > 0, total, 1.0), positions)
