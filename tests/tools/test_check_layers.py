"""tools/check_layers.py: this tree keeps the layers, and each kind of breach is seen where it stands."""

from __future__ import annotations

from pathlib import Path

import pytest
from trees import REPOSITORY, check, plant


def test_this_tree_keeps_the_layers() -> None:
    result = check("check_layers", REPOSITORY)
    assert result.returncode == 0, result.stdout


CPP_BREACHES = [
    ("src/kernels/a.h", '#include "lower/b.h"', "kernels may not include lower"),
    ("src/kernels/a.h", '#include "../lower/b.h"', "kernels may not include lower"),
    ("src/mesh/a.cpp", '#include "lower/b.h"', "mesh may not include lower"),
    ("src/engine/a.cpp", '#include "lower/b.h"', "engine may not include lower"),
    ("src/lower/a.cpp", '#include "lower/absent.h"', "is no file below src/"),
    ("src/helpers/a.cpp", "", "is no room of the design"),
    ("src/kernels/a.h", "#include <vector>", "<vector>"),
    ("src/kernels/a.h", "#include <string>", "<string>"),
    ("src/kernels/a.h", "#include <cmath>", "<cmath>"),
    ("src/kernels/a.h", "int f(std::vector<int>& x);", "std::vector"),
    ("src/kernels/a.h", "float* p = new float[3];", "new"),
    ("src/kernels/a.h", "void f(float* p) { delete p; }", "delete"),
    ("src/kernels/a.h", "void* p = malloc(4);", "malloc("),
    ("src/kernels/a.h", "void f() { throw 1; }", "throw"),
    ("src/kernels/a.h", "struct A { virtual float f(); };", "virtual"),
    ("src/kernels/a.h", "#ifdef __CUDACC_RTC__\n#endif", "__CUDACC_RTC__"),
    ("src/kernels/a.h", "#if defined(_MSC_VER)\n#endif", "_MSC_VER"),
    ("src/kernels/a.h", "__device__ float f();", "__device__"),
    ("src/kernels/a.h", "auto x = _mm_sqrt_ps(y);", "_mm_sqrt_ps"),
]


@pytest.mark.parametrize(("name", "line", "message"), CPP_BREACHES)
def test_cpp_breach_is_seen(tmp_path: Path, name: str, line: str, message: str) -> None:
    plant(tmp_path, "src/lower/b.h", "#pragma once\n")
    plant(tmp_path, name, f"#pragma once\n{line}\n")
    result = check("check_layers", tmp_path)
    assert result.returncode == 1
    assert message in result.stdout
    assert f"{name}:2:" in result.stdout or not line


def test_kernel_may_say_in_text_what_it_may_not_do(tmp_path: Path) -> None:
    plant(tmp_path, "src/kernels/port.h", "#include <cmath>\n#ifdef __CUDACC_RTC__\n#endif\n")
    plant(tmp_path, "src/kernels/a_test.cpp", '#include <vector>\n#include "kernels/a.h"\nstd::vector<int> x;\n')
    plant(
        tmp_path,
        "src/kernels/a.h",
        '#include "kernels/port.h"\n// a new path; throw nothing\n/* std::vector\n virtual */\n'
        'constexpr const char* doc = "the new \\"virtual\\" light";\nconst int n = 1\'000;\n'
        "struct A { A(const A&) = delete; };\n",
    )
    result = check("check_layers", tmp_path)
    assert result.returncode == 0, result.stdout


PYTHON_BREACHES = [
    ("accuray/scene/a.py", "import accuray.film.image", "scene may not import accuray.film"),
    ("accuray/scene/a.py", "from ..film import image", "scene may not import accuray.film"),
    ("accuray/scene/a.py", "from accuray import _core", "scene may not import accuray._core"),
    ("accuray/scene/a.py", "from accuray._core import engine", "scene may not import accuray._core.engine"),
    ("accuray/film/a.py", "from accuray.scene import load", "film may not import accuray.scene"),
    ("accuray/film/a.py", "import accuray", "film may not import the public API"),
    ("accuray/formats/a.py", "from accuray._core import schema", "formats may not import accuray._core.schema"),
    ("accuray/render/a.py", "from accuray._core import engine", "render may not import accuray._core.engine"),
    ("accuray/cli/a.py", "from accuray.film.image import Image", "cli may not import accuray.film"),
    ("accuray/cli/a.py", "def f():\n    from .. import film", "cli may not import accuray.film"),
    ("accuray/testing/a.py", "import scipy.stats", "testing may import only numpy, not scipy"),
    ("accuray/helpers/a.py", "", "is no room of the design"),
    ("blender/a.py", "import accuray.film", "blender may not import accuray.film"),
    ("accuray/scene/a.py", "def f(:", "cannot be parsed"),
]


@pytest.mark.parametrize(("name", "line", "message"), PYTHON_BREACHES)
def test_python_breach_is_seen(tmp_path: Path, name: str, line: str, message: str) -> None:
    plant(tmp_path, "accuray/film/__init__.py", "")
    plant(tmp_path, name, line)
    result = check("check_layers", tmp_path)
    assert result.returncode == 1
    assert message in result.stdout


def test_allowed_imports_pass(tmp_path: Path) -> None:
    plant(tmp_path, "accuray/__init__.py", "from accuray.render import session\n")
    plant(tmp_path, "accuray/scene/a.py", "from accuray._core import schema\nfrom accuray.data import colour\n")
    plant(tmp_path, "accuray/devices/a.py", "from accuray._core import engine\nfrom ..scene import model\n")
    plant(tmp_path, "accuray/render/a.py", "from accuray.film import film\nfrom . import session\n")
    plant(tmp_path, "accuray/testing/a.py", "import math\nimport numpy as np\nimport accuray\n")
    plant(tmp_path, "accuray/cli/a.py", "import accuray\nfrom accuray import Image\nfrom accuray.cli import progress\n")
    result = check("check_layers", tmp_path)
    assert result.returncode == 0, result.stdout
