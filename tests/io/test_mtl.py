from __future__ import annotations

import unicodedata
from functools import partial
from pathlib import Path
from typing import Literal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nispcodec.core.asset import Material, TexturedMesh
from nispcodec.core.errors import MeshError
from nispcodec.io.read.mtl import parse_mtl
from tests.io.files import TRIANGLE, image, load_obj, outcome

OBJ = "mtllib a.mtl\nusemtl m\n" + TRIANGLE + "f 1 2 3\n"


def load(folder: Path, mtl: str | bytes, **files: str | bytes) -> TexturedMesh:
    raw = mtl.encode() if isinstance(mtl, str) else mtl
    return load_obj(folder, OBJ, a_mtl=b"newmtl m\n" + raw, **files)


def material(folder: Path, mtl: str, **files: str | bytes) -> Material:
    return load(folder, mtl, **files).materials[0]


def test_factors(tmp_path: Path) -> None:
    made = material(tmp_path, "Kd .1 .2 .3\nd 0.5\nKe 0 0 .9\nPr 0.4\nPm 1\n")
    assert made.base_color == (0.1, 0.2, 0.3, 0.5)
    assert made.alpha_mode == "blend"
    assert made.emissive == (0.0, 0.0, 0.9)
    assert (made.roughness, made.metallic) == (0.4, 1.0)


@pytest.mark.parametrize(("line", "alpha"), [("Tr 0.25", 0.75), ("d -halo 0.5", 0.5), ("", 1.0)])
def test_alpha(tmp_path: Path, line: str, alpha: float) -> None:
    assert material(tmp_path, line).base_color[3] == alpha


def test_an_invisible_material_is_a_mistake(tmp_path: Path) -> None:
    mesh = load(tmp_path, "d 0\n")
    assert mesh.materials[0].base_color[3] == 1.0
    assert mesh.warnings == ("material 'm': invisible, taken as opaque",)


def test_one_number_is_a_gray(tmp_path: Path) -> None:
    assert material(tmp_path, "Kd .5\n").base_color[:3] == (0.5, 0.5, 0.5)


def test_base_color_map_keeps_its_bytes_and_its_factor(tmp_path: Path) -> None:
    mesh = load(tmp_path, "Kd 1 .5 1\nmap_Kd wood.png\n", wood_png=image())
    assert mesh.textures[0].data == image()
    assert (mesh.textures[0].name, mesh.textures[0].mime) == ("wood.png", "image/png")
    assert mesh.materials[0].base_color == (1.0, 0.5, 1.0, 1.0)
    assert mesh.warnings == ()


def test_black_under_a_map_means_the_map_alone(tmp_path: Path) -> None:
    mesh = load(tmp_path, "Kd 0 0 0\nmap_Kd wood.png\n", wood_png=image())
    assert mesh.materials[0].base_color == (1.0, 1.0, 1.0, 1.0)
    assert "black Kd" in mesh.warnings[0]


@pytest.mark.parametrize("keyword", ["norm", "map_Bump", "map_bump", "bump", "map_BUMP"])
def test_every_name_of_a_normal_map(tmp_path: Path, keyword: str) -> None:
    made = material(tmp_path, f"{keyword} -bm 0.7 n.png\n", n_png=image())
    assert made.maps["normal"].strength == 0.7


def test_norm_goes_before_bump(tmp_path: Path) -> None:
    mesh = load(tmp_path, "bump b.png\nnorm n.png\n", n_png=image(), b_png=image(color=(0, 0, 9)))
    assert [texture.name for texture in mesh.textures] == ["n.png"]
    assert mesh.warnings == ("a.mtl:2: 'b.png': bump gives way to 'n.png'",)


def test_a_gray_bump_is_no_normal_map(tmp_path: Path) -> None:
    mesh = load(tmp_path, "map_Bump b.png\n", b_png=image(color=(90, 90, 90)))
    assert mesh.materials[0].maps == {}
    assert mesh.textures == ()
    assert mesh.warnings == ("a.mtl:2: 'b.png': a gray height map, not a normal map: left out",)


def test_emissive_map_without_factor_shines(tmp_path: Path) -> None:
    made = material(tmp_path, "map_Ke e.png\n", e_png=image())
    assert made.emissive == (1.0, 1.0, 1.0)
    assert "emissive" in made.maps


def test_clamp_sets_the_wrap(tmp_path: Path) -> None:
    made = material(tmp_path, "map_Kd -blendu on -clamp on w.png\n", w_png=image())
    assert made.maps["base_color"].wrap == ("clamp", "clamp")


UV_OBJ = "mtllib a.mtl\n" + TRIANGLE + "vt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n"
UV_OBJ += "usemtl n\nf 3/3 2/2 1/1\n"


@pytest.mark.parametrize(
    ("options", "uvs"),
    [
        ("-s 2 3 1", [[0, 0], [2, 0], [0, 3]]),
        ("-s 2", [[0, 0], [2, 0], [0, 1]]),
        ("-o .5 .25", [[0.5, 0.25], [1.5, 0.25], [0.5, 1.25]]),
        ("-o .5 0 0 -s 2 2 1", [[0.5, 0], [2.5, 0], [0.5, 2]]),
    ],
)
def test_options_that_move_uvs_move_those_of_their_material(
    tmp_path: Path, options: str, uvs: list[list[float]]
) -> None:
    mtl = f"newmtl m\nmap_Kd {options} w.png\nnewmtl n\nmap_Kd w.png\n"
    mesh = load_obj(tmp_path, UV_OBJ, a_mtl=mtl, w_png=image())
    assert mesh.warnings == ()
    assert mesh.corner_uvs[0].tolist() == uvs
    assert mesh.corner_uvs[1].tolist() == [[0, 1], [1, 0], [0, 0]]


def test_maps_that_lie_differently_give_a_warning(tmp_path: Path) -> None:
    mtl = "newmtl m\nnorm n.png\nmap_Kd -s 2 2 w.png\nnewmtl n\n"
    mesh = load_obj(tmp_path, UV_OBJ, a_mtl=mtl, w_png=image(), n_png=image(color=(128, 128, 255)))
    assert "-s and -o of its maps differ; those of base_color" in mesh.warnings[0]
    assert mesh.corner_uvs[0].max() == 2


def test_a_turbulence_is_not_applied(tmp_path: Path) -> None:
    mesh = load(tmp_path, "map_Kd -t 1 1 1 w.png\n", w_png=image())
    assert mesh.warnings[0].startswith("a.mtl:2: 'w.png': -t is not applied")


@pytest.mark.parametrize("option", ["-s 1 1 1", "-o 0", "-t 0.0 0 0", "-blendu on -texres 512"])
def test_options_without_effect_are_no_loss(tmp_path: Path, option: str) -> None:
    assert load(tmp_path, f"map_Kd {option} w.png\n", w_png=image()).warnings == ()


@pytest.mark.parametrize(
    "written",
    [
        "my wood.png",
        '"my wood.png"',
        "MY Wood.PNG",
        ".\\my wood.png",
        "C:\\Users\\me\\textures\\my wood.png",
        "/home/me/my wood.png",
        "textures/my wood.png",
        "-bm 1 my wood.png  ",
        "my wood.png # as scanned",
    ],
)
def test_ways_to_name_an_image(tmp_path: Path, written: str) -> None:
    (tmp_path / "my wood.png").write_bytes(image())
    mesh = load(tmp_path, f"map_Kd {written}\n")
    assert mesh.warnings == ()
    assert mesh.textures[0].name == "my wood.png"


@pytest.mark.parametrize(
    "keyword", ["map_d", "map_Ns", "map_Pr", "map_Pm", "disp", "refl", "map_Ka"]
)
def test_unsupported_maps_are_named(tmp_path: Path, keyword: str) -> None:
    mesh = load(tmp_path, f"map_Kd w.png\n{keyword} other.png\n", w_png=image())
    (warning,) = mesh.warnings
    assert keyword.lower() in warning
    assert "other.png" in warning


def test_base_color_repeated_as_ambient_is_no_loss(tmp_path: Path) -> None:
    assert load(tmp_path, "map_Kd w.png\nmap_Ka w.png\n", w_png=image()).warnings == ()


def test_one_image_in_several_materials_is_one_texture(tmp_path: Path) -> None:
    mesh = load_obj(
        tmp_path,
        "mtllib a.mtl\n" + TRIANGLE + "usemtl a\nf 1 2 3\nusemtl b\nf 3 2 1\n",
        a_mtl="newmtl a\nmap_Kd w.png\nnewmtl b\nmap_Kd W.PNG\n",
        w_png=image(),
    )
    assert len(mesh.textures) == 1
    assert [made.maps["base_color"].texture for made in mesh.materials] == [0, 0]


def test_materials_nobody_uses_are_not_read(tmp_path: Path) -> None:
    mesh = load(tmp_path, "newmtl unused\nmap_Kd broken.png\n", broken_png=b"no image")
    assert len(mesh.materials) == 1
    assert mesh.warnings == ()


def test_missing_files_are_named_and_the_rest_goes_on(tmp_path: Path) -> None:
    mesh = load(tmp_path, "Kd 1 0 0\nmap_Kd gone.png\n")
    assert mesh.warnings == ("a.mtl:3: 'gone.png': image not found",)
    assert mesh.materials[0].base_color == (1.0, 0.0, 0.0, 1.0)
    mesh = load_obj(tmp_path, OBJ.replace("a.mtl", "gone.mtl"))
    assert mesh.warnings == ("a.obj:1: material file 'gone.mtl' not found",)
    assert mesh.materials[0].name == "m"


def test_a_material_that_no_file_holds(tmp_path: Path) -> None:
    mesh = load_obj(tmp_path, OBJ, a_mtl="newmtl other\n")
    assert mesh.warnings == ("material 'm' is in no material file",)


@pytest.mark.parametrize("written", ["a.mtl b.mtl", "b.mtl\nmtllib a.mtl"])
def test_several_libraries(tmp_path: Path, written: str) -> None:
    mesh = load_obj(
        tmp_path, OBJ.replace("a.mtl", written), a_mtl="newmtl m\nKd 1 0 0\n", b_mtl="newmtl n\n"
    )
    assert mesh.materials[0].base_color[:3] == (1.0, 0.0, 0.0)
    assert mesh.warnings == ()


def load_two(folder: Path, text: str) -> TexturedMesh:
    """An OBJ beside two files that hold a red and a green material of one name."""
    files = {"a_mtl": "newmtl m\nKd 1 0 0\n", "b_mtl": "newmtl m\nKd 0 1 0\n"}
    return load_obj(folder, TRIANGLE + text, **files)


def reds(mesh: TexturedMesh) -> list[float]:
    return [mesh.materials[number].base_color[0] for number in mesh.face_materials]


@pytest.mark.parametrize(
    ("text", "red", "counts"),
    [
        ("mtllib a.mtl b.mtl\nusemtl m\nf 1 2 3\n", 1.0, "a.mtl"),
        ("mtllib b.mtl a.mtl\nusemtl m\nf 1 2 3\n", 0.0, "b.mtl"),
        ("mtllib a.mtl\nmtllib b.mtl\nusemtl m\nf 1 2 3\n", 0.0, "b.mtl"),
        ("usemtl m\nf 1 2 3\nmtllib a.mtl\nmtllib b.mtl\n", 1.0, "a.mtl"),
    ],
)
def test_of_two_materials_of_a_name_one_counts(
    tmp_path: Path, text: str, red: float, counts: str
) -> None:
    mesh = load_two(tmp_path, text)
    assert reds(mesh) == [red]
    (warning,) = mesh.warnings
    assert warning.startswith("material 'm' is not the same in ")
    assert warning.endswith(f": that of {counts} counts")


def test_in_merged_files_each_part_has_the_materials_named_last(tmp_path: Path) -> None:
    first = "mtllib a.mtl\nusemtl m\nf 1 2 3\n"
    mesh = load_two(tmp_path, first + "mtllib b.mtl\nusemtl m\nf 1 3 2\n" + first)
    assert reds(mesh) == [1.0, 0.0]
    assert len(mesh.materials) == 2
    assert mesh.warnings[0] == (
        "material 'm' is not the same in a.mtl and in b.mtl: "
        "of these the one whose mtllib comes last before a face counts"
    )


def test_the_same_material_in_two_files_is_one(tmp_path: Path) -> None:
    same = "newmtl m\nKd 1 0 0\nmap_Kd w.png\n"
    text = OBJ + OBJ.replace("a.mtl", "b.mtl").replace("1 2 3", "1 3 2")
    mesh = load_obj(tmp_path, text, a_mtl=same, b_mtl="# other\n" + same, w_png=image())
    assert mesh.warnings == ("dropped 3 unreferenced vertices",)
    assert len(mesh.materials) == 1


@pytest.mark.parametrize("cut", ["", " # as scanned", " #2 # as scanned"])
def test_a_number_sign_may_belong_to_a_name(tmp_path: Path, cut: str) -> None:
    names = [f"Grey #{n}{cut}" for n in (1, 2)]
    faces = "".join(f"usemtl {name}\nf 1 2 3\nf 1 3 2\n" for name in names)
    mtl = "".join(f"newmtl Grey #{n}{cut}\nKd {n - 1} 0 0\n" for n in (1, 2))
    mesh = load_obj(tmp_path, "mtllib a.mtl\n" + TRIANGLE + faces, a_mtl=mtl)
    assert [made.base_color[0] for made in mesh.materials] == [0.0, 1.0]
    assert mesh.face_materials.tolist() == [0, 0, 1, 1]
    assert mesh.warnings == ()


@pytest.mark.parametrize(("used", "made"), [("m # top", "m"), ("m", "m # top")])
def test_a_comment_after_a_name_is_none_of_it(tmp_path: Path, used: str, made: str) -> None:
    text = OBJ.replace("usemtl m", f"usemtl {used}\nf 1 3 2\nusemtl m")
    mesh = load_obj(tmp_path, text, a_mtl=f"newmtl {made}\nKd 1 0 0\n")
    assert len(mesh.materials) == 1
    assert mesh.materials[0].base_color[:3] == (1.0, 0.0, 0.0)


@pytest.mark.parametrize("name", ["lib #3.mtl", "lib # a #3.mtl", "my #3.mtl"])
def test_a_library_with_a_number_sign(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text("newmtl m\nmap_Kd wood #2.png # oak\n")
    (tmp_path / "wood #2.png").write_bytes(image())
    mesh = load_obj(tmp_path, OBJ.replace("a.mtl", name))
    assert [texture.name for texture in mesh.textures] == ["wood #2.png"]
    assert mesh.warnings == ()


def test_several_libraries_with_spaces_in_their_names(tmp_path: Path) -> None:
    (tmp_path / "my lib.mtl").write_text("newmtl m\nKd 1 0 0\n")
    (tmp_path / "b c.mtl").write_text("newmtl n\n")
    mesh = load_obj(tmp_path, OBJ.replace("a.mtl", "my lib.mtl  gone lib.mtl b c.mtl"))
    assert mesh.materials[0].base_color[:3] == (1.0, 0.0, 0.0)
    assert mesh.warnings == ("a.obj:1: material file 'gone lib.mtl' not found",)


def test_images_lie_beside_their_material_file(tmp_path: Path) -> None:
    (tmp_path / "maps").mkdir()
    (tmp_path / "maps" / "a.mtl").write_text("newmtl m\nmap_Kd w.png\nnorm n.png\n")
    (tmp_path / "maps" / "w.png").write_bytes(image())
    mesh = load_obj(tmp_path, OBJ.replace("a.mtl", "maps/a.mtl"), n_png=image(color=(9, 9, 255)))
    assert [texture.name for texture in mesh.textures] == ["w.png", "n.png"]


def test_an_image_at_its_very_path_goes_before_others_of_its_name(tmp_path: Path) -> None:
    for folder, red in (("mats", 1), ("tex", 2)):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "w.png").write_bytes(image(color=(red, 0, 0)))
    (tmp_path / "mats" / "a.mtl").write_text("newmtl m\nmap_Kd tex/w.png\n")
    mesh = load_obj(tmp_path, OBJ.replace("a.mtl", "mats/a.mtl"))
    assert mesh.textures[0].data == image(color=(2, 0, 0))


@pytest.mark.parametrize(
    ("first", "second", "warned"),
    [
        ("a/w.png", "b/w.png", True),
        ("C:\\x\\a\\w.png", "C:\\x\\b\\w.png", True),
        ("C:\\x\\a\\w.png", "A/W.png", False),
        ("w.png", "b/w.png", False),
    ],
)
def test_one_image_in_the_place_of_two(
    tmp_path: Path, first: str, second: str, warned: bool
) -> None:
    mtl = f"newmtl m\nmap_Kd {first}\nnewmtl n\nmap_Kd {second}\n"
    mesh = load_obj(tmp_path, UV_OBJ, a_mtl=mtl, w_png=image())
    assert len(mesh.textures) == 1
    taken = "/".join(first.lower().split("\\"))
    said = f"a.mtl:4: {second!r}: not found, w.png is taken for it as for {taken!r}"
    assert mesh.warnings == ((said,) if warned else ())


@pytest.mark.parametrize("composed_in_mtl", [True, False])
def test_accents_are_composed_either_way(tmp_path: Path, composed_in_mtl: bool) -> None:
    names = [unicodedata.normalize("NFC", "Ö.png"), unicodedata.normalize("NFD", "Ö.png")]
    written, stored = names if composed_in_mtl else reversed(names)
    (tmp_path / stored).write_bytes(image())
    assert len(load(tmp_path, f"map_Kd {written.lower()}\n").textures) == 1


def test_a_tab_in_a_name(tmp_path: Path) -> None:
    mesh = load_obj(
        tmp_path, OBJ.replace("usemtl m", "usemtl m\tn"), a_mtl="newmtl m\tn\nKd 1 0 0\n"
    )
    assert mesh.materials[0].name == "m_n"
    assert mesh.materials[0].base_color[:3] == (1.0, 0.0, 0.0)


def test_materials_without_any_library_are_named(tmp_path: Path) -> None:
    mesh = load_obj(tmp_path, TRIANGLE + "usemtl a\nf 1 2 3\nusemtl b\nf 3 2 1\n")
    assert mesh.warnings == ("materials 'a', 'b' are in no material file",)


@pytest.mark.parametrize("written", ["my lib.mtl", '"my lib.mtl"'])
def test_a_library_name_with_spaces(tmp_path: Path, written: str) -> None:
    (tmp_path / "my lib.mtl").write_text("newmtl m\nKd 1 0 0\n")
    mesh = load_obj(tmp_path, OBJ.replace("a.mtl", written))
    assert mesh.materials[0].base_color[:3] == (1.0, 0.0, 0.0)


@pytest.mark.parametrize(
    "line", ["Kd 1 nan 0", "Kd -nan(ind) 0 0", "Pr 1.#QNAN", "d inf", "Kd red", "d"]
)
def test_a_value_that_is_no_finite_number_is_left_out(tmp_path: Path, line: str) -> None:
    mesh = load(tmp_path, line + "\n")
    keyword, _, values = line.partition(" ")
    expected = f"expected 1 or more finite numbers, found {values or 'nothing'!r}"
    assert mesh.warnings == (f"a.mtl:2: {expected}: {keyword.lower()} left out",)
    assert mesh.materials[0] == Material("m")


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ("-bm x", "numbers after -bm, found 'x'"),
        ("-s on", "numbers after -s, found 'on'"),
        ("-o nan 0 -nan(ind)", "numbers after -o, found 'nan 0 -nan(ind)'"),
        ("-clamp yes", "on or off after -clamp, found 'yes'"),
        ("-colorspace srgb", "an option of MTL, found '-colorspace'"),
        ("-mm", "numbers after -mm, found 'my'"),
        ("-S", "numbers after -s, found 'my'"),
    ],
)
def test_a_malformed_option_costs_itself_alone(tmp_path: Path, options: str, expected: str) -> None:
    (tmp_path / "my w.png").write_bytes(image())
    mesh = load(tmp_path, f"Kd 1 0 0\nmap_Kd {options} my w.png\n")
    assert mesh.warnings == (f"a.mtl:3: expected {expected}: left out",)
    assert mesh.materials[0].base_color == (1.0, 0.0, 0.0, 1.0)
    (used,) = mesh.materials[0].maps.values()
    assert mesh.textures[used.texture].name == "my w.png"
    assert (used.wrap, used.strength) == (("repeat", "repeat"), 1.0)


def test_options_around_a_malformed_one_count(tmp_path: Path) -> None:
    mesh = load(tmp_path, "norm -clamp on -o x -bm .5 n.png\n", n_png=image())
    (used,) = mesh.materials[0].maps.values()
    assert (used.wrap, used.strength) == (("clamp", "clamp"), 0.5)
    assert len(mesh.warnings) == 1


@pytest.mark.parametrize("end", ["", " -clamp on", " -s 2 2", ' ""', " # wood.png"])
def test_a_map_without_a_name_is_left_out(tmp_path: Path, end: str) -> None:
    mesh = load(tmp_path, f"Kd 1 0 0\nmap_Kd{end}\n")
    assert mesh.materials[0] == Material("m", base_color=(1.0, 0.0, 0.0, 1.0))
    (warning,) = mesh.warnings
    assert warning.startswith("a.mtl:3:")


def test_a_name_may_begin_as_an_option(tmp_path: Path) -> None:
    (tmp_path / "-wood.png").write_bytes(image())
    mesh = load(tmp_path, "map_Kd -wood.png\n")
    assert [texture.name for texture in mesh.textures] == ["-wood.png"]
    assert mesh.warnings == ()


def test_two_numbers_are_no_color(tmp_path: Path) -> None:
    mesh = load(tmp_path, "Kd 1 0\nPr .5\n")
    assert mesh.materials[0] == Material("m", roughness=0.5)
    assert mesh.warnings == ("a.mtl:2: expected 1 or 3 numbers, found '1 0': kd left out",)


@pytest.mark.parametrize("line", ["Kd spectral wood.rfl", "Kd xyz .5 .5 .5"])
def test_colors_of_other_kinds_are_left_out(tmp_path: Path, line: str) -> None:
    mesh = load(tmp_path, line)
    assert mesh.materials[0].base_color == (1.0, 1.0, 1.0, 1.0)
    assert "a.mtl:2: expected a color in RGB" in mesh.warnings[0]


def test_a_material_that_is_there_twice(tmp_path: Path) -> None:
    mesh = load(tmp_path, "Kd 1 0 0\nnewmtl m\nKd 0 1 0\n")
    assert mesh.materials[0].base_color[:3] == (0.0, 1.0, 0.0)
    assert mesh.warnings == ("a.mtl:3: material 'm' is there twice: the last counts",)


@pytest.mark.parametrize("form", ["NFC", "NFD"])
def test_accents_of_materials_are_composed_either_way(
    tmp_path: Path, form: Literal["NFC", "NFD"]
) -> None:
    other: Literal["NFC", "NFD"] = "NFD" if form == "NFC" else "NFC"
    names = unicodedata.normalize(form, "Öl"), unicodedata.normalize(other, "Öl")
    text = OBJ.replace("usemtl m", f"usemtl {names[0]}")
    mesh = load_obj(tmp_path, text, a_mtl=f"newmtl {names[1]}\nKd 1 0 0\n")
    assert mesh.materials[0].base_color[:3] == (1.0, 0.0, 0.0)
    assert mesh.warnings == ()


def test_a_backslash_ends_a_path_and_goes_on_in_no_line(tmp_path: Path) -> None:
    mesh = load(tmp_path, "map_Bump C:\\tex\\\nKd 0 1 0\n")
    assert mesh.materials[0].base_color[:3] == (0.0, 1.0, 0.0)
    assert mesh.warnings == ("a.mtl:2: 'C:\\\\tex\\\\': image not found",)


def test_statements_that_are_left_out_are_named_once(tmp_path: Path) -> None:
    mesh = load(tmp_path, "Tf .2 .2 .2\nPc 1\nnormal n.png\nPc .5\n")
    assert mesh.warnings == ("a.mtl: left out statements 'tf', 'pc', 'normal', first in line 2",)


@pytest.mark.parametrize("line", ["Tf 1 1 .5", "Tf xyz 1 1 1", "Ps .1", "aniso .3", "1", "\x00"])
def test_a_statement_that_is_left_out_is_named(tmp_path: Path, line: str) -> None:
    (warning,) = load(tmp_path, line).warnings
    keyword = line.split(" ")[0].lower()
    assert warning == f"a.mtl: left out statement {keyword!r}, first in line 2"


def test_what_every_exporter_writes_is_no_loss(tmp_path: Path) -> None:
    lines = "Ns 250\nKa 1 1 1\nKs .5 .5 .5\nNi 1.45\nillum 2\nsharpness 60\nTf 1.0 1.0 1.0\n"
    lines += "Tf 0 0 0\nPs 0.0\nPc 0.000\nPcr .03\naniso 0\nanisor 0\n"
    assert load(tmp_path, lines).warnings == ()


def test_a_file_of_other_kind_gives_one_warning(tmp_path: Path) -> None:
    noise = "\n".join(f"k{number} 1" for number in range(1000))
    (warning,) = load(tmp_path, noise).warnings
    assert warning.endswith("'k7', ..., first in line 2")


def test_words_that_are_no_options_take_no_time(tmp_path: Path) -> None:
    mesh = load(tmp_path, "map_Kd " + "-x " * 50_000 + "w.png\n", w_png=image())
    assert len(mesh.warnings) < 20


def test_colors_beyond_one_are_cut_and_said(tmp_path: Path) -> None:
    mesh = load(tmp_path, "Kd 255 128 0\nillum two\nNs -1\nNi x\n")
    assert mesh.materials[0].base_color == (1.0, 1.0, 0.0, 1.0)
    assert mesh.warnings == ("a.mtl:2: expected numbers from 0 to 1, found '255 128 0': cut to it",)


WORDS = ["newmtl", "m", "Kd", "d", "Ke", "1", "0", "nan", "spectral", "-halo", "norm", "map_Kd"]
WORDS += ["bump", "-bm", "-s", "-clamp", "on", "w.png", "gone.png", "#", "map_d", "\\", "Tr", "\n"]


@given(st.lists(st.sampled_from(WORDS), max_size=15).map(" ".join))
def test_any_words_give_a_material_or_a_mesh_error(
    tmp_path_factory: pytest.TempPathFactory, mtl: str
) -> None:
    found = outcome(partial(load, w_png=image()), tmp_path_factory.getbasetemp(), mtl)
    assert isinstance(found, TexturedMesh | MeshError)


@given(
    st.lists(
        st.one_of(
            st.binary(max_size=20),
            st.sampled_from([b"newmtl", b"Kd 1", b"map_Kd -s", b"map_Kd -bm", b"d -halo", b"norm"]),
        )
    ).map(b"\n".join)
)
def test_any_bytes_give_materials_or_a_mesh_error(data: bytes) -> None:
    found = outcome(parse_mtl, data, "a.mtl", [])
    assert isinstance(found, dict) or str(found).startswith("a.mtl:")
