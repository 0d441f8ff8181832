#!/usr/bin/env python3
"""Builds the shared library and the program of the Python package: fpm compiles the sources, one line of gfortran links them.

    scripts/python/build_library.py [FOLDER]            FOLDER/libgudgeon.so; FOLDER: build/library of the checkout
    scripts/python/build_library.py --install PREFIX    the library, gudgeon.h and the program with its pages into PREFIX/lib, include,
                                                        bin and share

fpm links a shared library without the flags that it needs; therefore it only compiles here, from a folder with a manifest of its
own. OpenMP stays out of the library, so that a host may have its own; -frecursive keeps local arrays out of static memory.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
COMPILE = (
    "-O3 -flto=auto -fno-ipa-modref -fno-tree-vectorize --param max-inline-insns-auto=150"
    " -fPIC -fno-semantic-interposition -frecursive"
)
#: What the program prints, and where man and the shells look for it.
PAGES = {
    ("--man",): "share/man/man1/gudgeon.1",
    ("--completion", "bash"): "share/bash-completion/completions/gudgeon",
    ("--completion", "zsh"): "share/zsh/site-functions/_gudgeon",
    ("--completion", "fish"): "share/fish/vendor_completions.d/gudgeon.fish",
}
#: Functions of FMI, by that of the sources which does the work of all of them.
FMI = {
    "fmi_free_instance": "fmi2FreeInstance fmi3FreeInstance",
    "fmi_exit_initialization": "fmi2ExitInitializationMode fmi3ExitInitializationMode",
    "fmi_terminate": "fmi2Terminate fmi3Terminate",
    "fmi_reset": "fmi2Reset fmi3Reset",
    "fmi_get_state": "fmi2GetFMUstate fmi3GetFMUState",
    "fmi_set_state": "fmi2SetFMUstate fmi3SetFMUState",
    "fmi_free_state": "fmi2FreeFMUstate fmi3FreeFMUState",
    "fmi_accepted": "fmi2SetDebugLogging fmi3SetDebugLogging fmi2EnterInitializationMode",
    "fmi_no_instance": "fmi3InstantiateModelExchange fmi3InstantiateScheduledExecution",
    "fmi_refused": """
        fmi2GetBoolean fmi2GetString fmi2SetBoolean fmi2SetString fmi2SerializedFMUstateSize fmi2SerializeFMUstate
        fmi2DeSerializeFMUstate fmi2GetDirectionalDerivative fmi2EnterEventMode fmi2NewDiscreteStates fmi2EnterContinuousTimeMode
        fmi2CompletedIntegratorStep fmi2SetTime fmi2SetContinuousStates fmi2GetDerivatives fmi2GetEventIndicators
        fmi2GetContinuousStates fmi2GetNominalsOfContinuousStates fmi2SetRealInputDerivatives fmi2GetRealOutputDerivatives
        fmi2CancelStep fmi2GetIntegerStatus fmi2GetStringStatus

        fmi3GetFloat32 fmi3GetInt8 fmi3GetUInt8 fmi3GetInt16 fmi3GetUInt16 fmi3GetUInt32 fmi3GetInt64 fmi3GetUInt64 fmi3GetString
        fmi3GetBinary fmi3GetClock fmi3SetFloat32 fmi3SetInt8 fmi3SetUInt8 fmi3SetInt16 fmi3SetUInt16 fmi3SetUInt32 fmi3SetInt64
        fmi3SetUInt64 fmi3SetString fmi3SetBinary fmi3SetClock fmi3GetNumberOfVariableDependencies fmi3GetVariableDependencies
        fmi3SerializedFMUStateSize fmi3SerializeFMUState fmi3DeserializeFMUState fmi3GetDirectionalDerivative
        fmi3GetAdjointDerivative fmi3EnterConfigurationMode fmi3ExitConfigurationMode fmi3GetIntervalDecimal fmi3GetIntervalFraction
        fmi3GetShiftDecimal fmi3GetShiftFraction fmi3SetIntervalDecimal fmi3SetIntervalFraction fmi3SetShiftDecimal
        fmi3SetShiftFraction fmi3EvaluateDiscreteStates fmi3UpdateDiscreteStates fmi3EnterContinuousTimeMode
        fmi3CompletedIntegratorStep fmi3SetTime fmi3SetContinuousStates fmi3GetContinuousStateDerivatives fmi3GetEventIndicators
        fmi3GetContinuousStates fmi3GetNominalsOfContinuousStates fmi3GetNumberOfEventIndicators fmi3GetNumberOfContinuousStates
        fmi3EnterStepMode fmi3EnterEventMode fmi3GetOutputDerivatives fmi3ActivateModelPartition""",
}
MANIFEST = """name = "gudgeon"
[build]
auto-executables = false
auto-tests = false
auto-examples = false
[library]
source-dir = "src"
"""


def sources() -> Path:
    """The sources: of the checkout, or of the source distribution."""
    inside = HERE / "fortran"
    return inside if inside.is_dir() else HERE.parent.parent / "src"


def build(folder: Path) -> Path:
    """Build the library in a folder and return its path. Raises RuntimeError with the messages of the compiler."""
    for tool in ("gfortran", "fpm"):
        if shutil.which(tool) is None:
            raise RuntimeError(f"building gudgeon needs {tool}: install gfortran (fpm comes with pip install fpm)")
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "fpm.toml").write_text(MANIFEST)
    shutil.rmtree(folder / "src", ignore_errors=True)
    (folder / "src").mkdir()
    names = sorted(path for path in sources().iterdir() if path.is_dir())
    for path in names:
        (folder / "src" / path.name).symlink_to(path, target_is_directory=True)
    listed = "\n".join(sorted(str(path) for path in [*sources().rglob("*.f90"), *sources().rglob("*.c")]))
    listing = folder / "sources.txt"
    if not listing.is_file() or listing.read_text() != listed:  # fpm would link objects of files that are gone
        shutil.rmtree(folder / "build", ignore_errors=True)
        listing.write_text(listed)
    run(["fpm", "build", "--directory", str(folder), "--flag", COMPILE, "--c-flag", "-O2 -fPIC"], folder)
    objects = found_objects(folder)
    library = folder / "libgudgeon.so"
    if library.is_file() and all(os.path.getmtime(path) < library.stat().st_mtime for path in [*objects, __file__]):
        return library
    link = ["-shared", f"-Wl,--version-script={HERE / 'exports.map'}", "-Wl,-z,defs", "-Wl,-rpath,$ORIGIN"]
    link += [f"-Wl,--defsym={name}={one}" for one, names in FMI.items() for name in names.split()]
    run(["gfortran", *COMPILE.split(), *link, *objects, "-o", f"{library}.part"], folder)
    os.replace(f"{library}.part", library)
    return library


def build_program(folder: Path) -> Path:
    """Link the program from the objects of a library that has been built in the folder."""
    program, objects = folder / "gudgeon", found_objects(folder)
    if program.is_file() and all(os.path.getmtime(path) < program.stat().st_mtime for path in objects):
        return program
    modules = str(Path(next((folder / "build").rglob("version_number.mod"))).parent)
    needed = [path for path in objects if "_api_" not in Path(path).name]
    run(["gfortran", *COMPILE.split(), f"-I{modules}", str(sources() / "main.f90"), *needed, "-o", f"{program}.part"], folder)
    os.replace(f"{program}.part", program)
    return program


def install(prefix: Path) -> None:
    """Build everything and put it where compilers, shells and man look for it."""
    folder = HERE.parent.parent / "build" / "library"
    files = {build(folder): "lib/libgudgeon.so", sources() / "api" / "gudgeon.h": "include/gudgeon.h", build_program(folder): "bin/gudgeon"}
    for source, place in files.items():
        (prefix / place).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source, prefix / place)
    for words, place in PAGES.items():
        (prefix / place).parent.mkdir(parents=True, exist_ok=True)
        (prefix / place).write_text(page(prefix / "bin" / "gudgeon", words))


def page(program: Path, words: tuple[str, ...]) -> str:
    """What the program prints with these words."""
    return subprocess.run([program, *words], check=True, capture_output=True, text=True).stdout


def found_objects(folder: Path) -> list[str]:
    """The objects of the last build: fpm has a folder for those of Fortran and one for those of C."""
    newest = [max((folder / "build").rglob(kind), key=os.path.getmtime).parent.glob(kind) for kind in ("*.f90.o", "*.c.o")]
    return sorted(str(path) for paths in newest for path in paths)


def run(command: list[str], folder: Path) -> None:
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(command[:4])} ... failed:\n{done.stdout[-4000:]}{done.stderr[-4000:]}")


if __name__ == "__main__":
    try:
        if sys.argv[1:2] == ["--install"] and len(sys.argv) == 3:
            install(Path(sys.argv[2]).resolve())
        else:
            print(build(Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else HERE.parent.parent / "build" / "library"))
    except (RuntimeError, OSError) as error:
        sys.exit(f"build_library: {error}")
