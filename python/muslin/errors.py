"""Errors, each with a problem and a remedy."""


class Error(Exception):
    """Something is wrong with input, files or numbers.

    ``str(error)`` reads ``FILE:LINE:COLUMN: problem; remedy``, without what is unknown.
    """

    exit_code: int = 1
    """Exit code of the program ``muslin`` for such an error."""

    def __init__(self, problem: str, remedy: str = "", file: str = "", line: int = 0, column: int = 0) -> None:
        super().__init__(problem, remedy, file, line, column)
        self.problem = problem
        """The problem."""
        self.remedy = remedy
        """The remedy."""
        self.file = file
        """The file it is in, empty if unknown."""
        self.line = line
        """Counts from 1, 0 if unknown."""
        self.column = column
        """Counts from 1, 0 if unknown."""

    def __str__(self) -> str:
        place = self.file
        if self.line > 0:
            place += f":{self.line}"
            place += f":{self.column}" if self.column > 0 else ""
        text = f"{place}: {self.problem}" if place else self.problem
        return f"{text}; {self.remedy}" if self.remedy else text


class UsageError(Error, ValueError):
    """A call is wrong: an argument, an array's shape, a name."""

    exit_code = 2


class InputError(Error, ValueError):
    """A scene, a mesh, a material or a checkpoint is wrong."""

    exit_code = 3


class SolverError(Error, ArithmeticError):
    """The solver failed; the simulation has the state of the last good step."""

    exit_code = 4


class FileError(Error):
    """A file cannot be read or written: missing, no permission, disk full."""

    exit_code = 5


class Interrupted(Error):
    """Stopped because ``cancel`` returned true; the work can be continued."""

    exit_code = 130
