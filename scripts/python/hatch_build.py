"""Hooks of hatchling: the commands of the package; its build, which compiles the shared library and the program into the package. With
GUDGEON_PREFIX in the environment they are those that `build_library.py --install` has put there, and the package has none of its own."""

import os
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path

from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from hatchling.metadata.plugin.interface import MetadataHookInterface

sys.path.insert(0, str(Path(__file__).resolve().parent))
import build_library


class Commands(MetadataHookInterface):
    """The commands of the package. As entry points: pip writes the scripts, which start also in a folder whose name has a blank."""

    def update(self, metadata):
        metadata["scripts"] = {"gudgeon-fmu": "gudgeon._fmu:main", "gudgeon-plot": "gudgeon.cli:main"}
        if not os.environ.get("GUDGEON_PREFIX"):
            metadata["scripts"]["gudgeon"] = "gudgeon._launch:main"


class Hook(BuildHookInterface):
    def initialize(self, version, build_data):
        package = Path(self.root) / "src" / "gudgeon"
        build_data["artifacts"] += ["src/gudgeon/_groups.pyi"]
        if prefix := os.environ.get("GUDGEON_PREFIX"):
            library = Path(prefix) / "lib" / "libgudgeon.so"
        else:
            library = self.compile(package, build_data)
        subprocess.run([sys.executable, str(Path(self.root) / "make_stubs.py")], check=True, env={**os.environ, "GUDGEON_LIBRARY": str(library)})

    def compile(self, package, build_data):
        """Compile into the package; returns the path of the library."""
        top, program = Path(self.root).parent.parent, package / "bin" / "gudgeon"
        program.parent.mkdir(exist_ok=True)
        with tempfile.TemporaryDirectory() as temporary:
            folder = top / "build" / "library" if (top / "fpm.toml").is_file() else Path(temporary)
            shutil.copy(build_library.build(folder), package / "libgudgeon.so")
            shutil.copy(build_library.build_program(folder), program)
        build_data["pure_python"] = False
        build_data["tag"] = "py3-none-" + sysconfig.get_platform().replace("-", "_").replace(".", "_")
        build_data["artifacts"] += ["src/gudgeon/libgudgeon.so", "src/gudgeon/bin/gudgeon"]
        for words, place in build_library.PAGES.items():
            page = package / "bin" / ("-".join(words) + ".page")
            page.write_text(build_library.page(program, words))
            build_data["shared_data"][str(page)] = place
        return package / "libgudgeon.so"
