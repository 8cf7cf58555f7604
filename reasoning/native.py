"""Cache the machine code of kernels on disk, and run it without numba.

Importing numba and loading its cached functions takes 0.4 s of processor time, several times as long as grounding a
scene of a dozen objects. `keep` compiles a kernel for the types of one call as a C function, and writes its object
code beside the kernel's module. `load` gives the object code to LLVM, which takes milliseconds, and calls it by
ctypes. The name of a file is a digest of everything that the code depends on: the kernel and the kernels that it calls,
their constants, the types, the processor and its features, and the versions of Python, numpy, numba and llvmlite. So
stale code is never found, and whatever cannot be kept or loaded runs by numba.

Object code of numba calls functions of its run time (memory, random numbers, errors). They are in two extension modules
of numba, which are loaded without the package.
"""

from __future__ import annotations

import ctypes
import hashlib
import json
import os
import sys
import threading
from collections.abc import Callable, Iterator
from functools import cache
from importlib import import_module
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any

import numpy as np

MAGIC = b"deixis native 1\n"

SCALARS = {
    "b1": ctypes.c_bool,
    "i4": ctypes.c_int32,
    "i8": ctypes.c_int64,
    "u4": ctypes.c_uint32,
    "u8": ctypes.c_uint64,
    "f4": ctypes.c_float,
    "f8": ctypes.c_double,
}
"""Types of numbers in C, by kind and bytes as numpy writes them."""


MAX_RECENT, MAX_RECENT_BYTES = 32, 1 << 18
"""Maximum number of tuples of arrays whose addresses are remembered, and of bytes of the arrays of one."""

_RECENT: dict[int, tuple[tuple[Any, ...], str, list[Any]]] = {}  # by id: the tuple, its type and its numbers


class UnsupportedTypeError(TypeError):
    """A type that a kept kernel cannot take or return."""


def type_of(argument: Any) -> str:
    """Return the type of an argument, written as a text.

    Parameters
    ----------
    argument
        A number, a C-contiguous array of numbers, or a tuple of these.

    Returns
    -------
    str
        The type: ``f8`` for a float, ``f4[2]`` for a matrix of single precision, ``(i8,f8[1])`` for a tuple.

    Raises
    ------
    UnsupportedTypeError
        If the argument is something else.

    Examples
    --------
    >>> type_of((3, np.zeros((2, 2))))
    '(i8,f8[2])'
    """
    return _taken(argument, [])


def _taken(argument: Any, values: list[Any]) -> str:
    """Return the type of an argument, and append its numbers as C takes them: for an array its address and shape."""
    kind = type(argument)
    if kind is np.ndarray:
        flags, name = argument.flags, argument.dtype.str[1:]
        if not (flags.c_contiguous and flags.aligned and argument.dtype.isnative and name in SCALARS):
            raise UnsupportedTypeError("not a C-contiguous array of numbers")
        values.append(argument.__array_interface__["data"][0])
        values.extend(argument.shape)
        return f"{name}[{argument.ndim}]"
    if isinstance(argument, tuple):
        recent = _RECENT.get(id(argument))
        if recent is not None and recent[0] is argument:
            values.extend(recent[2])
            return recent[1]
        start = len(values)
        parts = ",".join([_taken(part, values) for part in argument])
        name = f"({parts})" if kind is tuple else f"{kind.__module__}.{kind.__qualname__}({parts})"
        if sum(part.nbytes for part in argument if isinstance(part, np.ndarray)) <= MAX_RECENT_BYTES:
            if len(_RECENT) >= MAX_RECENT:
                _RECENT.clear()
            _RECENT[id(argument)] = argument, name, values[start:]
        return name
    if kind is bool:
        name = "b1"
    elif isinstance(argument, int):
        name = "i8" if kind is int and -(2**63) <= argument < 2**63 else ""
    elif kind is float:
        name = "f8"
    elif isinstance(argument, np.generic):
        name = argument.dtype.str[1:]
    else:
        name = ""
    if name not in SCALARS:
        raise UnsupportedTypeError(f"no C type for {kind.__name__}")
    values.append(argument)
    return name


class Native:
    """The machine code of a kernel for the types of its arguments.

    Parameters
    ----------
    address
        Address of the C function.
    taken
        C types of the numbers that the function takes, those of its arguments in turn.
    returned
        Types of the results, keys of ``SCALARS``; none of them is None.
    single
        True if the result is a number, false if it is a tuple.
    releases_gil
        True to let other threads of Python run meanwhile.
    """

    def __init__(self, address: int, taken: list[Any], returned: list[str], single: bool, releases_gil: bool) -> None:
        prototype = ctypes.CFUNCTYPE if releases_gil else ctypes.PYFUNCTYPE
        self.results: list[Any] = [SCALARS[name] for name in returned]
        self.single = single
        self.function = prototype(None, *taken, *[ctypes.c_void_p] * (len(returned) + 1))(address)

    def __call__(self, values: list[Any]) -> tuple[bool, Any]:
        """Run the code, and return whether it ended without an error, and its result."""
        done, slots = ctypes.c_int64(), [kind() for kind in self.results]
        self.function(*values, *[ctypes.byref(slot) for slot in slots], ctypes.byref(done))
        result = tuple(slot.value for slot in slots)
        return bool(done.value), (result[0] if self.single else result) if slots else None


class NativeKernel:
    """The kept machine code of one kernel, for all types that it was kept for.

    Parameters
    ----------
    function
        The Python function of the kernel.
    others
        The functions of the kernels that it calls, and that these call.
    options
        Options of ``numba.njit``.
    """

    RAISED = object()
    """Result of a run that raised an error."""

    def __init__(self, function: Callable[..., Any], others: list[Callable[..., Any]], options: dict[str, Any]) -> None:
        self.function, self.others, self.options = function, others, options
        self.loaded: dict[str, Native | None] = {}
        self.kept: dict[str, bool] = {}  # whether the code for some types was kept by this process

    def run(self, arguments: tuple[Any, ...]) -> tuple[bool, Any]:
        """Run the kept code for the types of the arguments.

        Parameters
        ----------
        arguments
            Arguments of the kernel.

        Returns
        -------
        tuple
            True and the result of the kernel; False and None if no code is kept; False and ``RAISED`` if the kernel
            raised an error, maybe after it changed arguments.
        """
        values: list[Any] = []
        try:
            types = ",".join([_taken(argument, values) for argument in arguments])
        except UnsupportedTypeError:
            return False, None
        native = self.loaded.get(types, self)
        if native is self:
            native = self.loaded[types] = self._load(types, arguments)
        if not isinstance(native, Native):
            return False, None
        done, result = native(values)
        return (True, result) if done else (False, self.RAISED)

    def path(self, types: str) -> Path:
        """Return the file of the code for arguments of some types.

        Parameters
        ----------
        types
            Their types.

        Returns
        -------
        Path
            The file, which may not exist.
        """
        digest = hashlib.sha256(f"{platform()}\n{types}\n{sorted(self.options.items())}\n".encode())
        for function in (self.function, *self.others):
            for part in _parts(function.__code__, function.__globals__):
                digest.update(part.encode("utf-8", "surrogatepass") + b"\n")
        elsewhere = os.environ.get("NUMBA_CACHE_DIR")
        folder = Path(elsewhere) if elsewhere else Path(self.function.__code__.co_filename).parent / "__pycache__"
        name = f"{self.function.__module__.rpartition('.')[2]}.{self.function.__name__}"
        return folder / f"{name}.{digest.hexdigest()[:24]}.native"

    def _load(self, types: str, arguments: tuple[Any, ...]) -> Native | None:
        """Load the kept code; None if there is none, or it cannot be loaded."""
        try:
            magic, digest, header, code = self.path(types).read_bytes().split(b"\n", 3)
            if magic + b"\n" != MAGIC or hashlib.sha256(header + code).hexdigest() != digest.decode():
                return None
            signature = json.loads(header)
            address = _linked(signature["symbol"], code)
        except (OSError, ValueError, ImportError, RuntimeError, LookupError, AttributeError):
            return None
        taken = list(_c_types(arguments))
        return Native(address, taken, signature["returned"], signature["single"], bool(self.options.get("nogil")))

    def keep(self, dispatcher: Any, arguments: tuple[Any, ...]) -> bool:
        """Compile the kernel for the types of the arguments, and write its code.

        Parameters
        ----------
        dispatcher
            Numba's dispatcher of the kernel, which was called with arguments of these types.
        arguments
            Arguments of the kernel.

        Returns
        -------
        bool
            True if the code is on disk, false if the types are not supported or the folder cannot be written.
        """
        try:
            types = ",".join(map(type_of, arguments))
        except UnsupportedTypeError:
            return False
        with _LOCK:
            if types not in self.kept:
                self.kept[types] = self._write(self.path(types), dispatcher, arguments)
            return self.kept[types]

    def _write(self, path: Path, dispatcher: Any, arguments: tuple[Any, ...]) -> bool:
        """Compile the kernel, and write its code if it is not there; return whether it is there now."""
        if path.exists():
            return True
        errors: Any = import_module("numba.core.errors")
        try:
            symbol, code, returned, single = _compiled(dispatcher, arguments)
            header = json.dumps({"symbol": symbol, "returned": returned, "single": single}).encode()
            digest = hashlib.sha256(header + code).hexdigest().encode()
            path.parent.mkdir(parents=True, exist_ok=True)
            new = path.with_suffix(f".{os.getpid()}.new")
            new.write_bytes(MAGIC + digest + b"\n" + header + b"\n" + code)
            new.replace(path)
        except (UnsupportedTypeError, OSError, LookupError, RuntimeError, errors.NumbaError):
            return False
        return True


def _parts(code: CodeType, scope: dict[str, Any]) -> Iterator[str]:
    """Yield what compiled code is made from: the bytecode of a function, its constants and the constants it names."""
    yield code.co_code.hex()
    yield repr((code.co_names, code.co_varnames, code.co_freevars))
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _parts(constant, scope)
        else:
            yield repr(constant)
    for name in code.co_names:
        value = scope.get(name)
        if isinstance(value, bool | int | float | str | tuple | np.generic):
            yield f"{name}={value!r}"
        elif isinstance(value, type):
            yield f"{name}={value.__qualname__}{getattr(value, '_fields', ())}"


def _c_types(arguments: tuple[Any, ...]) -> Iterator[Any]:
    for argument in arguments:
        if isinstance(argument, np.ndarray):
            yield ctypes.c_void_p
            yield from [ctypes.c_int64] * argument.ndim
        elif isinstance(argument, tuple):
            yield from _c_types(argument)
        else:
            yield SCALARS[type_of(argument)]


# ---- compiling, by numba


def _compiled(dispatcher: Any, arguments: tuple[Any, ...]) -> tuple[str, bytes, list[str], bool]:
    """Return the name of a C function that calls the kernel, its object code, and the types of its results."""
    import llvmlite.binding as llvm

    numba: Any = import_module("numba")
    parameters: list[tuple[str, Any]] = []
    scope: dict[str, Any] = {"kernel": dispatcher, "carray": numba.carray}
    given = ", ".join([_rebuilt(one, f"a{i}", parameters, scope) for i, one in enumerate(arguments)])
    result = dispatcher.overloads[tuple(map(numba.typeof, arguments))].signature.return_type
    single = not isinstance(result, numba.types.BaseTuple)
    results = [] if result == numba.none else [result] if single else list(result.types)
    returned = [_name_of(kind) for kind in results]
    lines = [f"result = kernel({given})"]
    for i, kind in enumerate(results):
        parameters.append((f"r{i}", numba.types.CPointer(kind)))
        lines.append(f"carray(r{i}, (1,))[0] = result" + ("" if single else f"[{i}]"))
    parameters.append(("done", numba.types.CPointer(numba.int64)))
    lines.append("carray(done, (1,))[0] = 1")
    body = "\n    ".join(lines)
    exec(f"def in_c({', '.join(name for name, _ in parameters)}):\n    {body}\n", scope)
    function = numba.cfunc(numba.void(*[kind for _, kind in parameters]))(scope["in_c"])
    module = llvm.parse_assembly(function.inspect_llvm())
    return function.native_name, _machine().emit_object(module), returned, single


def _rebuilt(argument: Any, name: str, parameters: list[tuple[str, Any]], scope: dict[str, Any]) -> str:
    """Add the parameters that carry an argument, and return the expression that makes the argument of them."""
    numba: Any = import_module("numba")
    if isinstance(argument, np.ndarray):
        shape = [f"{name}_{axis}" for axis in range(argument.ndim)]
        parameters.append((name, numba.types.CPointer(numba.from_dtype(argument.dtype))))
        parameters += [(length, numba.int64) for length in shape]
        return f"carray({name}, ({''.join(f'{length}, ' for length in shape)}))"
    if isinstance(argument, tuple):
        parts = [_rebuilt(part, f"{name}_{i}", parameters, scope) for i, part in enumerate(argument)]
        scope[f"{name}_type"] = type(argument)
        return f"({', '.join(parts)},)" if type(argument) is tuple else f"{name}_type({', '.join(parts)})"
    parameters.append((name, numba.typeof(argument)))
    return name


def _name_of(kind: Any) -> str:
    """Return the name in SCALARS of a type of numba."""
    numba: Any = import_module("numba")
    for name in SCALARS:
        if numba.from_dtype(np.dtype(name)) == kind:
            return name
    raise UnsupportedTypeError(f"no C type for {kind}")


# ---- loading, without numba


@cache
def platform() -> str:
    """Return everything beside the kernel that its machine code depends on.

    Returns
    -------
    str
        Processor, and versions of Python, numpy, numba and llvmlite.

    Raises
    ------
    ImportError
        If numba is not installed.
    """
    import llvmlite
    import llvmlite.binding as llvm

    numba = (_folder_of_numba() / "_version.py").read_text(encoding="utf-8")
    processor = f"{llvm.get_process_triple()} {llvm.get_host_cpu_name()} {llvm.get_host_cpu_features().flatten()}"
    return f"{processor}\n{sys.version}\n{np.__version__}\n{numba}\n{llvmlite.__version__}"


@cache
def _folder_of_numba() -> Path:
    from importlib.util import find_spec

    spec = find_spec("numba")
    if spec is None or spec.origin is None:
        raise ImportError("numba is not installed")
    return Path(spec.origin).parent


@cache
def _machine() -> Any:
    """Return LLVM's target: this processor, with code at any address."""
    import llvmlite.binding as llvm

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    return llvm.Target.from_default_triple().create_target_machine(
        cpu=llvm.get_host_cpu_name(),
        features=llvm.get_host_cpu_features().flatten(),
        opt=3,
        reloc="default",
        codemodel="jitdefault",
        jit=True,
    )


@cache
def _announce_run_time() -> None:
    """Tell LLVM the addresses of the functions of numba's run time."""
    import builtins

    import llvmlite.binding as llvm

    helpers, memory = _extension("numba._helperlib"), _extension("numba.core.runtime._nrt_python")
    memory.memsys_use_cpython_allocator()
    symbols = {f"numba_{name}": address for name, address in helpers.c_helpers.items()}
    symbols |= {name if name[0] == "_" else f"NRT_{name}": address for name, address in memory.c_helpers.items()}
    symbols["_Py_NoneStruct"] = id(None)
    for error in vars(builtins).values():
        if isinstance(error, type) and issubclass(error, BaseException):
            symbols[f"PyExc_{error.__name__}"] = id(error)
    for name, address in symbols.items():
        llvm.add_symbol(name, address)


def _extension(name: str) -> ModuleType:
    """Load an extension module of numba without the package, which finds it in ``sys.modules`` if it comes later."""
    from importlib.machinery import EXTENSION_SUFFIXES, ExtensionFileLoader
    from importlib.util import module_from_spec, spec_from_loader

    if name in sys.modules:
        return sys.modules[name]
    stem = _folder_of_numba().joinpath(*name.split(".")[1:])
    for suffix in EXTENSION_SUFFIXES:
        file = stem.with_name(stem.name + suffix)
        if file.exists():
            spec = spec_from_loader(name, ExtensionFileLoader(name, str(file)))
            assert spec is not None and spec.loader is not None
            module = module_from_spec(spec)
            spec.loader.exec_module(module)
            sys.modules[name] = module
            return module
    raise ImportError(f"{stem} is missing")


_ENGINES: list[Any] = []  # they own the code
_LOCK = threading.Lock()


def _linked(symbol: str, code: bytes) -> int:
    """Return the address of a function in object code."""
    import llvmlite.binding as llvm

    with _LOCK:
        _announce_run_time()
        engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), _machine())
        engine.add_object_file(llvm.ObjectFileRef.from_data(code))
        engine.finalize_object()
        _ENGINES.append(engine)
        address = int(engine.get_function_address(symbol))
    if address == 0:
        raise LookupError(symbol)
    return address
