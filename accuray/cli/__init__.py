"""The command line: `accuray VERB ...`, one module of this package per verb.

A verb's module has `SUMMARY`, `configure(parser)` and `run(options) -> exit status`. Only the module of the verb that
was asked for is imported, and the engine only once it has something to do, so that the command starts at once.

Exit status: 0 done; 1 failed, or a tolerance was exceeded; 2 wrong usage or an invalid scene or image; 130 and 143
interrupted by SIGINT and SIGTERM.
Standard output carries only what was asked for; everything else goes to standard error.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from importlib import import_module

from .parser import Parser, UsageError, nearest

VERBS = ("render", "merge", "compare", "info", "convert", "verify", "schema", "doctor")

FAILED = 1
USAGE = 2
INTERRUPTED = 130


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command line (default: that of this process) and returns its exit status; raises only SystemExit."""
    if arguments is None:
        arguments = sys.argv[1:]
        # Linear algebra is no part of what the command does: without this numpy starts a thread of it per processor.
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    verbose = any(word in ("-v", "-vv", "--verbose") for word in arguments)
    try:
        status = dispatch(arguments)
        sys.stdout.flush()
        return status
    except UsageError as error:
        return complain(f"{error}\nTry: {error.command} --help", USAGE)
    except KeyboardInterrupt:
        return complain("interrupted", INTERRUPTED)
    except BrokenPipeError:
        # Whoever read our output has gone. Python would complain again when it flushes at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return FAILED
    except Exception as error:  # the last line of defence: a user sees a sentence, not a traceback
        if verbose:
            import traceback

            traceback.print_exc()
        return complain(*explain(error))


def dispatch(arguments: Sequence[str]) -> int:
    """Runs the verb that comes first in `arguments` with the rest of them."""
    if not arguments or arguments[0].startswith("-"):
        return run_without_verb(arguments)
    verb = arguments[0]
    if verb not in VERBS:
        raise UsageError(f"unknown command {verb!r}; the nearest one is {nearest(verb, VERBS)!r}", "accuray")
    module = import_module(f"{__name__}.{verb}")
    parser = Parser(prog=f"accuray {verb}", description=module.SUMMARY)
    module.configure(parser)
    status: int = module.run(parser.parse(arguments[1:]))
    return status


def run_without_verb(arguments: Sequence[str]) -> int:
    """`accuray --help`, `accuray --version`, and what to say to everything else."""
    parser = Parser(prog="accuray", description="A spectral path tracer whose results can be trusted and repeated.")
    parser.add_argument("--version", action="store_true", help="print the version and stop")
    parser.usage = "accuray COMMAND ... | --version | --help"
    if not arguments or {"-h", "--help"} & set(arguments):
        modules = {verb: import_module(f"{__name__}.{verb}") for verb in VERBS}
        parser.epilog = "commands:\n" + "\n".join(f"  {verb:<8}  {modules[verb].SUMMARY}" for verb in VERBS)
        parser.epilog += "\n\nEvery command explains itself: accuray COMMAND --help"
        parser.print_help(sys.stdout if arguments else sys.stderr)
        return 0 if arguments else USAGE
    parser.parse(arguments)

    import accuray

    print(f"accuray {accuray.__version__}")
    return 0


def explain(error: Exception) -> tuple[str, int]:
    """What to tell the user about an exception that ended a command, and the exit status."""
    if isinstance(error, ImportError):
        return f"the installation is incomplete: {error}", FAILED

    import accuray

    if isinstance(error, accuray.SceneError):
        return str(error), USAGE
    if isinstance(error, accuray.ImageError | OSError):
        return str(error), FAILED
    if isinstance(error, MemoryError):
        return "out of memory", FAILED
    return f"internal error: {type(error).__name__}: {error} (add -v to see where)", FAILED


def complain(message: str, status: int) -> int:
    """Prints an error to standard error and returns the exit status."""
    print(f"accuray: error: {message}", file=sys.stderr)
    return status
