from collections.abc import Iterable, Iterator, Mapping, Sequence
from os import PathLike
from typing import Any, Literal, TypeAlias, final, overload

import numpy
from numpy.typing import NDArray

__all__ = [
    "ask_list",
    "ask_read",
    "ask_write",
    "Audit",
    "audit",
    "check",
    "command",
    "commission",
    "trend",
    "Contour",
    "contour",
    "AxisCurrent",
    "Currents",
    "current",
    "current_of_recording",
    "Identified",
    "identify",
    "learn",
    "Limits",
    "Machine",
    "End",
    "Fix",
    "Message",
    "Messages",
    "plan",
    "Text",
    "trace",
    "verify",
    "replay",
    "run",
    "AuditSequence",
    "audit_sequence",
    "explain",
    "Circle",
    "Tuned",
    "circle",
    "tune",
    "State",
    "ProgramRun",
    "Timeline",
]

_Path: TypeAlias = str | PathLike[str]
_Program: TypeAlias = str | bytes | PathLike[str] | Text
_Kinds: TypeAlias = str | Iterable[str]
_State: TypeAlias = Literal["active", "ineffective", "inactive", "unconfigured", "unknown"]
_Severity: TypeAlias = Literal["error", "warning", "info"]
# With the keys of the records: `state`, `ways`, `more`.
_PossibleState: TypeAlias = dict[str, Any]

@final
class Text:
    """The text of a program, instead of a file.

    ``path`` names the file that it represents: called programs and the configuration are looked for
    from its folder, and messages name it. Bytes are decoded like a file: UTF-8, UTF-16 with its
    mark, otherwise code page 1252.
    """

    def __new__(cls, text: str | bytes, path: _Path | None = None) -> Text: ...
    @property
    def text(self) -> str: ...
    @property
    def path(self) -> str: ...

@final
class Machine:
    """The machine that programs run on.

    Without arguments it is described by the nearest ``frictcomp.toml``, from the folder of the
    program upwards, as on the command line. ``config`` names another one, ``isolated`` uses none.
    ``startup`` reads the axes from a start-up list or a TwinCAT project. ``enable`` assumes P-AXIS-00522 = 1 and an
    accepted value list for axes. ``variables`` are values that only the machine knows,
    ``{"V.E.PART": 3}``. ``allow_outside`` lets programs call others in any folder.
    """

    def __new__(
        cls,
        config: _Path | None = None,
        *,
        startup: _Path | None = None,
        isolated: bool = False,
        enable: Iterable[str] | None = None,
        variables: Mapping[str, float | str] | None = None,
        allow_outside: bool = False,
    ) -> Machine: ...
    @staticmethod
    def from_project(
        project: _Path,
        *,
        enable: Iterable[str] | None = None,
        variables: Mapping[str, float | str] | None = None,
        allow_outside: bool = False,
    ) -> Machine:
        """The machine whose lists a TwinCAT project holds: a ``.tsproj``, an ``.xti`` or an exported tree item."""
    def __getnewargs_ex__(self) -> tuple[tuple[()], dict[str, Any]]: ...

@final
class End:
    """An end of the program that a message about program end refers to."""

    @property
    def file(self) -> str: ...
    @property
    def line(self) -> int:
        """Line of the block, from 1."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

@final
class Fix:
    """A change to the text that does what a message advises.

    The text from ``line``, ``column`` up to ``end_line``, ``end_column`` is replaced.
    """

    @property
    def file(self) -> str: ...
    @property
    def line(self) -> int: ...
    @property
    def column(self) -> int: ...
    @property
    def end_line(self) -> int: ...
    @property
    def end_column(self) -> int: ...
    @property
    def text(self) -> str: ...
    @property
    def safety(self) -> Literal["safe", "unsafe"]: ...
    @property
    def also(self) -> Fix | None:
        """A further change of the file that is made with it."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

@final
class Message:
    """One message about a program or a list, with the fields of a record of ``--format ndjson``.

    ``str(message)`` is ``file:line:column: severity[CODE] message``.
    """

    @property
    def program(self) -> int | None:
        """The program of the session, from 1; None if the message is about a list."""
    @property
    def seq(self) -> int | None:
        """The executed block of the program, from 1."""
    @property
    def code(self) -> str: ...
    @property
    def severity(self) -> _Severity: ...
    @property
    def file(self) -> str: ...
    @property
    def line(self) -> int:
        """Line of the block, from 1."""
    @property
    def column(self) -> int:
        """From 1, in characters."""
    @property
    def end_line(self) -> int: ...
    @property
    def end_column(self) -> int: ...
    @property
    def axis(self) -> str | None:
        """The axis that it refers to."""
    @property
    def message(self) -> str: ...
    @property
    def help(self) -> list[str]:
        """Advice."""
    @property
    def ends(self) -> list[End]:
        """The ends of the program that a message about program end refers to."""
    @property
    def fixes(self) -> list[Fix]:
        """Changes to the text, each of which alone does what is advised."""
    @property
    def reached_from(self) -> list[str]:
        """The main programs that reach the place of the message in a called program, at most 20."""
    @property
    def reached_from_count(self) -> int:
        """Number of main programs that reach it."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

@final
class Messages:
    """Messages in their order, and a table of them for pandas, polars and DuckDB.

    It has the methods of a ``Sequence`` and is not registered as one: polars reads a ``Sequence`` item
    by item, and not as a table.
    """

    @property
    def errors(self) -> int:
        """The number of errors, including those that are left out."""
    @property
    def warnings(self) -> int: ...
    @property
    def left_out(self) -> dict[str, int]:
        """The number of messages of a severity that are not listed: the list for each file is limited."""
    @property
    def remark(self) -> str | None:
        """A remark that no machine is described, where that matters."""
    def raise_for_errors(self) -> None:
        """Raises ``Error`` if there is a message of severity error."""
    def _repr_html_(self) -> str:
        """The messages with their places, for notebooks."""
    def __len__(self) -> int: ...
    @overload
    def __getitem__(self, index: int, /) -> Message: ...
    @overload
    def __getitem__(self, index: slice, /) -> list[Message]: ...
    def __iter__(self) -> Iterator[Message]: ...
    def __reversed__(self) -> Iterator[Message]: ...
    def __contains__(self, message: object, /) -> bool: ...
    def count(self, value: object) -> int: ...
    def index(self, value: object, start: int = 0, stop: int = ...) -> int: ...
    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object: ...

@final
class ProgramRun:
    """Course of a program of a run."""

    @property
    def program(self) -> int:
        """Its number in the session, from 1."""
    @property
    def file(self) -> str: ...
    @property
    def name(self) -> str | None:
        """The name after ``%``."""
    @property
    def by(self) -> str | None:
        """Cause of the end: ``M30``, ``M02``, ``end-of-file`` without either, ``error``, ``budget``.

        None if an interrupt or the end of the session came first.
        """
    @property
    def blocks(self) -> int:
        """Number of executed blocks."""
    @property
    def start(self) -> dict[str, _State]:
        """Friction compensation before its first block, by axis."""
    @property
    def end(self) -> dict[str, _State]:
        """Friction compensation after its end, by axis."""
    @property
    def possible(self) -> dict[str, list[_PossibleState]]:
        """The possible states after its end, by axis, where they differ between ways.

        Such an axis is ``unknown`` in ``end``. Each state has its ``ways``, lists of conditions that
        apply together, at most four, and ``more``, how many ways are not named. The state on all other
        ways has None for ``ways``.
        """

@final
class Timeline:
    """The timeline of a run: one row for each executed block.

    pandas, polars and DuckDB take it without a copy: ``polars.DataFrame(timeline)``,
    ``pandas.DataFrame.from_arrow(timeline)``, ``duckdb.sql("select * from timeline")``. The columns
    are those of ``frictcomp run --format csv``, with ``level`` as in NDJSON. ``branch`` gives the
    ways on which a block is executed, None for all of them; the CSV rows that are not a block, where ways
    meet, are left out.
    """

    @property
    def columns(self) -> list[str]: ...
    @property
    def axes(self) -> list[str]:
        """The axes that have a column."""
    @property
    def messages(self) -> Messages: ...
    @property
    def programs(self) -> list[ProgramRun]: ...
    @property
    def unrun(self) -> int:
        """Number of programs that did not run because an earlier one stopped the session."""
    @property
    def friction(self) -> dict[str, _State]:
        """Friction compensation of each axis at the end."""
    @property
    def possible(self) -> dict[str, list[_PossibleState]]:
        """The possible states at the end, as in ``ProgramRun``."""
    @property
    def state(self) -> State:
        """The state with which the next run starts."""
    @property
    def opaque(self) -> dict[str, int]:
        """Elements that were accepted and passed over, with their counts."""
    @property
    def is_assumed(self) -> bool:
        """Whether the states rest on an assumption (FC210, FC325, FC902)."""
    def raise_for_errors(self) -> None:
        """Raises ``Error`` if there is a message of severity error."""
    def svg(self, program: int = 1) -> str:
        """The picture of the states of friction compensation over the executed blocks of a program.

        ``program`` is its number in the session, from 1.
        """
    def _repr_html_(self) -> str:
        """The state bars of its first programs, for notebooks."""
    def __len__(self) -> int:
        """Number of executed blocks."""
    def __bool__(self) -> Literal[True]: ...
    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object: ...

@final
class State:
    """The result of a run with which the next one starts: states, variables, value lists."""

    @staticmethod
    def load(path: _Path) -> State:
        """Reads a state file, including one of the command line."""
    def save(self, path: _Path) -> None:
        """Writes a state file, which the command line also reads."""
    @staticmethod
    def from_json(text: str) -> State: ...
    def to_json(self) -> str:
        """The text of a state file."""
    @property
    def axes(self) -> list[str]: ...
    @property
    def away(self) -> list[tuple[str, str]]:
        """The axes that are not in their start-up state, each with the kind."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __reduce__(self) -> tuple[object, tuple[str]]: ...

@final
class Limits:
    """Limits of a dry run; the defaults are those of the command line.

    ``blocks`` bounds the executed blocks, ``work`` what macros, strings and unknown conditions cost
    beyond them, ``values`` the values that a program keeps; ``calls``, ``nesting`` and ``macros``
    bound the depth of calls, control blocks and macros. ``skip`` gives the skip levels that are on, all
    others are off; without it and without ``skip`` in ``frictcomp.toml``, it is unknown whether a
    block with a skip mark is executed.
    """

    def __new__(
        cls,
        *,
        blocks: int | None = None,
        work: int | None = None,
        values: int | None = None,
        calls: int | None = None,
        nesting: int | None = None,
        macros: int | None = None,
        skip: Iterable[int] | None = None,
    ) -> Limits: ...
    def __getnewargs_ex__(self) -> tuple[tuple[()], dict[str, Any]]: ...

@final
class Audit:
    """The effect of the order of programs: one row for each program, axis and kind.

    The table has the columns of ``frictcomp audit --format csv``.
    """

    @property
    def records(self) -> list[dict[str, Any]]:
        """The records of ``frictcomp audit --format ndjson``."""
    @property
    def columns(self) -> list[str]: ...
    @property
    def messages(self) -> Messages:
        """The errors that keep the control from accepting its lists."""
    @property
    def programs(self) -> int: ...
    @property
    def hazards(self) -> int:
        """The pairs of a program that leaves an axis away from its start-up state and one that inherits it."""
    @property
    def has_warnings(self) -> bool:
        """Whether something needs to be corrected, or is not known."""
    def _repr_html_(self) -> str:
        """The effect of each program on each axis, for notebooks."""
    def __len__(self) -> int: ...
    def __bool__(self) -> Literal[True]: ...
    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object: ...

@final
class AuditSequence:
    """The effect of programs in an order: one row for each program, axis and kind.

    ``str(sequence)`` has the lines of ``frictcomp audit --sequence``, one for each program.
    """

    @property
    def records(self) -> list[dict[str, Any]]:
        """The records of ``frictcomp audit --sequence --format ndjson``."""
    @property
    def columns(self) -> list[str]: ...
    @property
    def messages(self) -> Messages:
        """The errors that keep the control from accepting its lists."""
    @property
    def has_warnings(self) -> bool:
        """Whether a program moves an axis in a state that another one left."""
    def _repr_html_(self) -> str:
        """The states at the start and the end of each program, for notebooks."""
    def __len__(self) -> int: ...
    def __bool__(self) -> Literal[True]: ...
    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object: ...

@final
class Currents:
    """The additive currents of axes over the path of a program, cycle by cycle."""

    @property
    def t(self) -> NDArray[numpy.float64]:
        """The time of each cycle since the beginning of the program in s."""
    @property
    def line(self) -> NDArray[numpy.uint32]:
        """The line of the block that is executed."""
    @property
    def axes(self) -> list[str]: ...
    @property
    def messages(self) -> Messages:
        """Causes that stopped the program or the trace, and simplifications of the trace."""
    @property
    def left_out(self) -> int:
        """The number of motions that are not in the trace, because their start or end is not known."""
    def svg(self) -> str:
        """The picture of currents, velocities, weights and states over time, as ``frictcomp current --svg``
        draws it.
        """
    def _repr_html_(self) -> str:
        """Its picture, for notebooks."""
    def __contains__(self, key: str, /) -> bool: ...
    def __iter__(self) -> Iterator[str]:
        """Iterates over the names of the axes."""
    def __getitem__(self, key: str, /) -> AxisCurrent: ...
    def __len__(self) -> int:
        """Number of cycles."""
    def __bool__(self) -> Literal[True]: ...

@final
class AxisCurrent:
    """The additive current of one axis in each cycle, with the columns of ``frictcomp current``."""

    @property
    def axis(self) -> str:
        """The name of the axis; empty for a recording."""
    @property
    def t(self) -> NDArray[numpy.float64]:
        """The time of each cycle in s."""
    @property
    def x(self) -> NDArray[numpy.float64]:
        """The commanded position in 0.1 µm or 0.0001°."""
    @property
    def v(self) -> NDArray[numpy.float64]:
        """The commanded velocity in µm/s or 0.001°/s."""
    @property
    def w_before(self) -> NDArray[numpy.float64]:
        """The weight of the decay before a reversal, 0 to 1."""
    @property
    def w_after(self) -> NDArray[numpy.float64]:
        """The weight of the build-up after a reversal, 0 to 1."""
    @property
    def current(self) -> NDArray[numpy.float64]:
        """The additive current in drive units. ``Error`` if it is not known in every cycle."""
    @property
    def output(self) -> NDArray[numpy.int16]:
        """The integer that the drive gets. ``Error`` if it is not known in every cycle."""
    @property
    def comp(self) -> NDArray[numpy.str_]:
        """The state of friction compensation in each cycle."""
    def filled(self, unknown: float) -> NDArray[numpy.float64]:
        """The current, and the given value in the cycles in which it is not known."""
    @property
    def unknown_cycles(self) -> int:
        """The number of cycles in which the current is not known."""
    @property
    def saturated_cycles(self) -> int:
        """The number of cycles in which the output was limited to 16 bits."""
    @property
    def cycles_at_rest(self) -> int:
        """The number of cycles at standstill in which it matters what the control adds."""
    @property
    def remarks(self) -> list[str]:
        """The steps that converted the rows of a recording to cycles, a sentence each."""
    def svg(self) -> str:
        """The picture of current, velocity, weights and states over time."""
    def _repr_html_(self) -> str:
        """Its picture, for notebooks."""
    def __len__(self) -> int: ...
    def __bool__(self) -> Literal[True]: ...

@final
class Contour:
    """The path of a program driven by simulated axes: as programmed, with all compensation, with none."""

    @property
    def record(self) -> Any:
        """The document of ``frictcomp contour --format json``: figures, reversals, blocks."""
    @property
    def remarks(self) -> list[str]:
        """The feed that is reached, and what the figures rest on: a sentence each."""
    @property
    def messages(self) -> Messages:
        """Causes that stopped the program or the trace, and simplifications of the trace."""
    def svg(self) -> str:
        """The picture of the path with its magnified deviation, as ``frictcomp contour --svg`` draws it."""
    def _repr_html_(self) -> str:
        """Its picture, for notebooks."""

@final
class Circle:
    """A circular test: its figures and its picture."""

    @property
    def record(self) -> Any:
        """The document of ``frictcomp circle --format json``."""
    def svg(self) -> str:
        """The picture of the circle with its magnified deviation, as ``frictcomp circle --svg`` draws it."""
    def _repr_html_(self) -> str:
        """Its picture, for notebooks."""

@final
class Tuned:
    """The parameters of a value list that leave the smallest glitch on a simulated machine."""

    @property
    def record(self) -> Any:
        """The document of ``frictcomp tune --format json``."""
    def value_list(self, axis: Literal["X", "Y"] = "X", *, cnc_build: str | None = None) -> str:
        """The value list of an axis as a file of the control.

        Outputs are whole numbers unless ``cnc_build``, such as ``"3.1.3132.0"``, accepts fractions.
        """
    def svg(self) -> str:
        """The picture of the glitch before and after tuning, as ``frictcomp tune --svg`` draws it."""
    def _repr_html_(self) -> str:
        """Its picture, for notebooks."""

@final
class Identified:
    """The friction of an axis, and the value list that is made from it."""

    @property
    def record(self) -> Any:
        """The document of ``frictcomp identify --format json``."""
    def value_list(self, *, cnc_build: str | None = None) -> str:
        """The value list as a file of the control."""
    def svg(self) -> str:
        """The picture of the friction curve, as ``frictcomp identify --svg`` draws it.

        ``Error`` if friction was found on circles, for which there is no picture.
        """
    def _repr_html_(self) -> str:
        """Its picture, if it has one, for notebooks."""

def run(
    program: _Program | Iterable[_Program],
    *,
    machine: Machine | _Path | None = None,
    state: State | _Path | None = None,
    keep_going: bool = False,
    kinds: _Kinds | None = None,
    positions: bool = False,
    limits: Limits | None = None,
) -> Timeline:
    """Runs programs one after the other, as they are given, in one session of the control; a set has no order.

    A program is a path, or a text: ``Text``, or ``bytes``. ``state`` is what an earlier run left;
    the path of a state file is read and, at the end, written, as ``--state`` does. An error of the
    control stops the session unless ``keep_going`` is set. ``kinds`` adds columns such as ``X.LEAD``,
    ``positions`` adds ``X_pos`` in mm or degrees.
    """

def check(
    programs: _Program | Iterable[_Program],
    *,
    machine: Machine | _Path | None = None,
    limits: Limits | None = None,
    exclude: Iterable[str] | None = None,
    no_ignore: bool = False,
    baseline: _Path | None = None,
) -> Messages:
    """All messages of programs and of the programs below folders.

    Each program runs from the start of the control. Below folders, what the patterns of ``exclude`` name is not
    taken, and what ignore files name only with ``no_ignore``. ``baseline`` is a file of known findings, which
    ``frictcomp check --write-baseline`` wrote: they are left out. ``Error`` if one of the programs cannot be read.
    """

def audit(
    programs: _Program | Iterable[_Program],
    *,
    machine: Machine | _Path | None = None,
    kinds: _Kinds | None = None,
    limits: Limits | None = None,
) -> Audit:
    """Which programs leave an axis away from its start-up state, and which move it in the state that they find."""

def audit_sequence(
    programs: _Program | Iterable[_Program],
    *,
    machine: Machine | _Path | None = None,
    kinds: _Kinds | None = None,
    limits: Limits | None = None,
) -> AuditSequence:
    """Runs programs in the given order, from a start of the control, and reports their effect.

    The result shows what each of them changes, and where an axis first moves outside its start-up state,
    with the program that left it so.
    """

def current(
    program: _Program,
    axes: Iterable[str] | None = None,
    *,
    machine: Machine | _Path | None = None,
    value_list: _Path | None = None,
    cycle_time_ms: float | None = None,
    reading: str | None = None,
    start: Mapping[str, float] | Iterable[tuple[str, float]] | None = None,
    max_cycles: int = 3_600_000,
    limits: Limits | None = None,
) -> Currents:
    """The additive current of axes over the path of a program, as NumPy arrays.

    Without ``axes`` it is that of all axes with a value list. ``value_list`` replaces the lists of the
    machine. ``start`` gives the axis positions at the start, ``{"X": 0.0}``, in mm or degrees. ``reading``
    is that of ``--reading``. The trace ends after ``max_cycles``, which a message reports.
    """

def current_of_recording(
    recording: _Path,
    value_list: _Path,
    *,
    time: str | None = None,
    position: str | None = None,
    velocity: str | None = None,
    units: Mapping[str, str] | None = None,
    axis: str | None = None,
    cycle_time_ms: float | None = None,
    resample: bool = False,
    dead_band: float | None = None,
    reading: str | None = None,
) -> AxisCurrent:
    """The additive current of one axis over a recorded commanded motion, as NumPy arrays.

    The recording is an export of TwinCAT Scope, a SINUMERIK trace or a CSV file with the columns ``t`` in
    s, ``x`` in 0.1 µm or 0.0001°, ``v`` in µm/s or 0.001°/s and, where it is recorded, ``comp``; or
    ``time``, ``position`` and ``velocity`` name its channels, and ``units`` their units if the file
    does not. Of a recording of several axes, ``axis`` says which one is meant. Times that are not those
    of CNC cycles are refused unless ``resample`` is set. Velocities up to ``dead_band`` in µm/s or
    0.001°/s are standstill.
    """

def contour(
    program: _Program,
    *,
    machine: Machine | _Path | None = None,
    plane: str | Iterable[str] | None = None,
    plant: str = "stiff",
    model: str | None = None,
    value_list: Mapping[str, _Path] | None = None,
    cycle_time_ms: float | None = None,
    start: Mapping[str, float] | Iterable[tuple[str, float]] | None = None,
    max_cycles: int | None = None,
    limits: Limits | None = None,
) -> Contour:
    """Drives the path of a program with simulated axes: the document of ``frictcomp contour --format json``.

    The path is driven three times: with friction compensation as the program switches it, with all of
    it on, and with all of it off. ``plane`` is the view of the picture, ``"XY"`` or two names.
    ``value_list`` gives axes other lists than those of the machine, ``{"X": "comp_x.lis"}``. ``start``
    gives the axis positions at the start, ``{"X": 0.0}``, in mm or degrees.
    """

def circle(
    *,
    radius_mm: float | None = None,
    feed_mm_per_min: float | None = None,
    plant: str = "stiff",
    model: str | None = None,
    value_list: _Path | Mapping[str, _Path] | None = None,
    cycle_time_ms: float | None = None,
    reading: str | None = None,
    recordings: _Path | Iterable[_Path] | None = None,
    centre: Literal["common", "own"] | None = None,
) -> Circle:
    """A circular test, as ``frictcomp circle`` makes it.

    Two simulated axes drive the circle with compensation off and on; with ``recordings``, recorded
    circles are judged instead, with the radius and the feed that were commanded.
    """

def tune(
    *,
    plant: str = "stiff",
    feeds: Iterable[float] | None = None,
    radii: Iterable[float] | None = None,
    model: str | None = None,
    cycle_time_ms: float | None = None,
    reading: str | None = None,
    free: Iterable[str] | None = None,
    shaping: bool = True,
    cnc_build: str | None = None,
    robust: bool = False,
) -> Tuned:
    """Searches the value list with the smallest worst glitch over all feeds in mm/min and radii in mm.

    With ``robust`` the list is also good if the contact is half or twice as stiff, or friction
    differs by 10 % between the directions.
    """

def explain(word: str) -> str:
    """The page that the command `frictcomp explain` prints: about the code of a message, such as ``"FC401"``, an error number
    of the control, a parameter by its number or its key in the lists, such as ``"P-AXIS-00522"``, a rule or another word;
    as Markdown.
    """

def identify(
    recordings: _Path | Iterable[_Path],
    *,
    axis: str | None = None,
    time: str | None = None,
    position: str | None = None,
    velocity: str | None = None,
    torque: str | None = None,
    units: Mapping[str, str] | None = None,
    cycle_time_ms: float | None = None,
    circles: bool = False,
    points: int | None = None,
    max_error: float | None = None,
    feed_mm_per_min: float = 1000.0,
    torque_kind: Literal["actual", "command", "loop"] | None = None,
    compensation: Literal["on", "off"] | None = None,
) -> Identified:
    """Finds the friction of an axis in a recording, and the points of a value list.

    ``torque_kind`` says which torque was recorded and ``compensation`` whether friction compensation
    was on meanwhile; without them, the channels decide, if they show it.

    ``time``, ``position``, ``velocity`` and ``torque`` name channels, ``units`` their units if
    the file does not. With ``circles`` the recordings are circles at two or more feeds.
    ``points`` bounds the points of the list, ``max_error`` its error in per cent of the friction.
    """

def trace(
    recording: _Path,
    *,
    time: str | None = None,
    units: Mapping[str, str] | None = None,
) -> Any:
    """The channels of a recording with their rates, lengths, ranges and gaps: the document of ``frictcomp trace --format json``.

    ``time`` names the channel of the times, ``units`` its unit if the file does not.
    """

def verify(
    recording: _Path,
    value_list: _Path,
    *,
    axis: str | None = None,
    time: str | None = None,
    position: str | None = None,
    velocity: str | None = None,
    torque: str | None = None,
    actual_position: str | None = None,
    following_error: str | None = None,
    units: Mapping[str, str] | None = None,
    cycle_time_ms: float | None = None,
    torque_kind: Literal["actual", "command", "loop"] | None = None,
    compensation: Literal["on", "off"] | None = None,
    reading: str | None = None,
) -> Any:
    """Compares a recorded torque with what a value list predicts: the document of ``frictcomp verify --format json``.

    The channels are named as for ``identify``, which looks at the recording in the same way. ``actual_position`` or
    ``following_error`` shows whether the list acted, and whether it is early or late at reversals.
    """

def replay(
    recording: _Path,
    programs: _Program | Iterable[_Program],
    *,
    machine: Machine | _Path | None = None,
    time: str | None = None,
    active: Mapping[str, str] | None = None,
    position: Mapping[str, str] | None = None,
    line: str | None = None,
    block: str | None = None,
    program: str | None = None,
    units: Mapping[str, str] | None = None,
    tolerance_um: float | None = None,
    start: Mapping[str, float] | Iterable[tuple[str, float]] | None = None,
    limits: Limits | None = None,
) -> Any:
    """Compares what a machine did with the dry run of its programs: the document of ``frictcomp replay --format json``.

    The recording says for each axis whether friction compensation is active; ``active`` and ``position`` name its channels of
    axes, ``{"X": "FrictX"}``, if they are not recognised. The programs are those that ran meanwhile, in their order.
    ``tolerance_um`` is how much positions may differ where no blocks were recorded, in µm or 0.001°.
    """

def plan(
    axis: str | Iterable[str],
    *,
    travel: tuple[float, float] | Mapping[str, tuple[float, float]],
    feeds: Iterable[float],
    radius_mm: float | None = None,
    pitch: float | Mapping[str, float] | None = None,
    slowest: float | None = None,
    approach: float | None = None,
    value_list: _Path | Mapping[str, _Path] | None = None,
    into: _Path | None = None,
    machine: Machine | _Path | None = None,
) -> Any:
    """Plans the NC programs that measure friction: the document of ``frictcomp commission plan --format json``.

    ``axis`` is one axis, or two linear ones. ``travel`` is what is free of each, in mm or degrees, ``{"X": (0, 300)}``;
    nothing leaves its inner 90 %. ``feeds`` are those of circles or strokes in mm/min or °/min, at least four over a decade.
    ``pitch`` is the distance over which the torque repeats, ``slowest`` the slowest speed, by default 0.2 mm/s, ``approach``
    the feed of all motions that are not measured, by default 1000 mm/min. With ``value_list`` it is stage 2, with these lists
    on. Only ``into`` writes the programs, a page for the operator and the plan, to this folder.
    """

def commission(
    folder: _Path,
    *,
    time: str | None = None,
    position: str | None = None,
    velocity: str | None = None,
    torque: str | None = None,
    actual_position: str | None = None,
    following_error: str | None = None,
    units: Mapping[str, str] | None = None,
    cycle_time_ms: float | None = None,
    torque_kind: Literal["actual", "command", "loop"] | None = None,
    roles: Mapping[str, int] | None = None,
    plant: str | None = None,
    shaping: bool = True,
    cnc_build: str | None = None,
) -> Any:
    """Evaluates the recordings of a commissioning: the document of ``frictcomp commission run --format json``.

    Reads the plans in the folder and the recordings in its folder ``recordings``, writes a provisional list of each axis to
    its folder ``lists``, and what it found to ``results.json``. In the name of a channel ``%`` stands for that of each axis;
    ``roles`` are the numbers of the programs of recordings without a signature. With ``plant`` drives are fitted, and lists
    tuned on them, without ``shaping`` as the friction curve is.
    """

def learn(
    folder: _Path,
    *,
    plant: str,
    friction: _Path | Mapping[str, _Path] | None = None,
    value_list: _Path | Mapping[str, _Path] | None = None,
    model: str | None = None,
    cycle_time_ms: float | None = None,
    reading: str | None = None,
    time: str | None = None,
    position: str | Mapping[str, str] | None = None,
    units: Mapping[str, str] | None = None,
    cnc_build: str | None = None,
    write_list: _Path | Mapping[str, _Path] | None = None,
) -> Any:
    """Learns value lists from recorded circles, round by round: the document of ``frictcomp commission learn --format json``.

    The folder holds ``round-1``, ``round-2`` and so on, each with the lists ``X.lis`` and ``Y.lis`` and the circles that were
    recorded with them. The recordings judge the lists; ``plant`` gives only the direction of the next step. ``friction``
    begins the first round with the measured friction, ``value_list`` with other lists of at most 1.3 times as much. Each call
    judges what is recorded, and writes the lists of the next round and ``learning.json`` to the folder; no other list there is
    replaced. ``position`` names the channel of the actual positions, with ``%`` for the axis. ``write_list`` is where the best
    list of each axis is written, ``{"X": "comp_x.lis"}``.
    """

def trend(
    folder: _Path,
    *,
    axis: str | None = None,
    time: str | None = None,
    position: str | None = None,
    velocity: str | None = None,
    torque: str | None = None,
    units: Mapping[str, str] | None = None,
    cycle_time_ms: float | None = None,
    torque_kind: Literal["actual", "command", "loop"] | None = None,
    compensation: Literal["on", "off"] | None = None,
) -> Any:
    """Follows the friction of an axis over the dates of its recordings: the document of ``frictcomp commission trend --format
    json``.

    Takes every recording of constant speeds in a folder whose name holds a date, ``x-2026-03-01.csv``; the channels are named
    as for ``identify``.
    """

def ask_write(
    into: _Path,
    *,
    axis: str | None = None,
    travel: float | None = None,
    machine: Machine | _Path | None = None,
    cnc_build: str | None = None,
) -> Any:
    """Writes the NC programs that test on the control what its documents leave open, and a page for the operator.

    Only the folder ``into`` gets files, and no program there is replaced. ``axis`` is the axis to test, by default the first
    one with P-AXIS-00522 = 1; it moves no farther than ``travel``, by default 10 mm or degrees. Returns a document with the
    names of the programs.
    """

def ask_read(
    files: _Path | Iterable[_Path],
    *,
    axis: str | None = None,
    time: str | None = None,
    position: str | None = None,
    velocity: str | None = None,
    torque: str | None = None,
    units: Mapping[str, str] | None = None,
    cycle_time_ms: float | None = None,
    machine: Machine | _Path | None = None,
    cnc_build: str | None = None,
    into: _Path | None = None,
) -> Any:
    """Reads the answers of a control: the document of ``frictcomp ask read --format json``.

    The files are ``message.txt`` of the control, notes, and recordings, in which ``axis`` is read, by default the first one
    with P-AXIS-00522 = 1; their channels are named as for ``identify``, ``torque`` being the additive current. Only
    ``into``, a ``frictcomp.toml`` that may be new, records what is decided; without it nothing is written. ``unread`` of the
    document has the lines that are marked as answers and cannot be read.
    """

def ask_list(
    *,
    machine: Machine | _Path | None = None,
    cnc_build: str | None = None,
) -> Any:
    """The open questions, what is assumed, and what is answered: the document of ``frictcomp ask list --format json``."""

def command(arguments: Sequence[_Path]) -> int:
    """Runs the command line, the name of the program first; returns its exit status."""
