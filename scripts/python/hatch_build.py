"""Build hook of hatchling: compiles the shared library and the program into the package."""

import shutil
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

sys.path.insert(0, str(Path(__file__).resolve().parent))
import build_library

#: What the program prints, and where man and the shells look for it.
PAGES = {
    ("--man",): "share/man/man1/gudgeon.1",
    ("--completion", "bash"): "share/bash-completion/completions/gudgeon.bash",
    ("--completion", "zsh"): "share/zsh/site-functions/_gudgeon",
    ("--completion", "fish"): "share/fish/vendor_completions.d/gudgeon.fish",
}


class Hook(BuildHookInterface):
    def initialize(self, version, build_data):
        package = Path(self.root) / "src" / "gudgeon"
        top = Path(self.root).parent.parent
        with tempfile.TemporaryDirectory() as temporary:
            folder = top / "build" / "library" if (top / "fpm.toml").is_file() else Path(temporary)
            shutil.copy(build_library.build(folder), package / "libgudgeon.so")
            (package / "bin").mkdir(exist_ok=True)
            shutil.copy(build_library.build_program(folder), package / "bin" / "gudgeon")
        subprocess.run([sys.executable, str(Path(self.root) / "make_stubs.py")], check=True)
        for words, place in PAGES.items():
            page = package / "bin" / Path(place).name
            page.write_text(subprocess.run([package / "bin" / "gudgeon", *words], check=True, capture_output=True, text=True).stdout)
            build_data["shared_data"][str(page)] = place
        build_data["pure_python"] = False
        build_data["tag"] = "py3-none-" + sysconfig.get_platform().replace("-", "_").replace(".", "_")
        build_data["artifacts"] += ["src/gudgeon/libgudgeon.so", "src/gudgeon/bin/gudgeon", "src/gudgeon/_groups.pyi"]
