from __future__ import annotations

from pathlib import Path

import pytest
from nispcodec_web.bundle import bundled

from tests.web.programs import run_node


def written(folder: Path, **modules: str) -> Path:
    for name, source in modules.items():
        (folder / f"{name}.js").write_text(source)
    return folder / "main.js"


def test_modules_run_as_one_script(tmp_path: Path) -> None:
    entry = written(
        tmp_path,
        main='import {\n  two,\n  Three,\n} from "./parts.js";\n'
        "console.log(two() + new Three().value);",
        parts='/** A\n comment. */\nimport { one } from "./one.js";\n// Another.\n'
        "export function two() {\n  return one + 1;\n}\n"
        "export class Three {\n  value = 3;\n}\n",
        one="export const one = 1;\n",
    )
    script = tmp_path / "script.cjs"
    script.write_text(bundled(entry))
    assert run_node(script) == "5\n"
    assert "comment" not in script.read_text()
    assert "Another" not in script.read_text()


def test_what_it_does_not_understand_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="by name"):
        bundled(written(tmp_path, main='import * as all from "./one.js";', one=""))
    with pytest.raises(ValueError, match="by name"):
        bundled(written(tmp_path, main="export default 1;"))


def test_modules_in_a_circle_are_refused(tmp_path: Path) -> None:
    back = 'import { b } from "./main.js";\nexport const a = 1;'
    with pytest.raises(ValueError, match="circle"):
        bundled(
            written(tmp_path, main='import { a } from "./one.js";\nexport const b = 1;', one=back)
        )
