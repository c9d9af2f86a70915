"""Dry runs of ISG and TwinCAT CNC programs with an eye on friction compensation.

``run`` executes programs without a machine and returns their timeline: which axis has friction
compensation active after each block. The timeline is a table that pandas, polars and DuckDB accept
without a copy. ``check`` returns the messages of whole folders, ``audit`` the effect of the order of
programs. ``current``, ``contour``, ``circle``, ``tune``, ``identify`` and ``verify`` are about the compensation itself,
``trace`` shows what is in a recording, ``replay`` compares one with the dry run. ``plan`` writes measuring programs,
``commission``, ``learn`` and ``trend`` evaluate folders of recordings, ``ask_write``, ``ask_read`` and ``ask_list`` put to a
control what its documents leave open.

    import frictcomp, polars
    timeline = frictcomp.run("part.nc")
    polars.DataFrame(timeline)

A state that depends on a value that only the machine knows is ``"unknown"``: a separate value,
never a missing one.
"""

from importlib.metadata import version as _version

from ._engine import (
    Audit,
    AuditSequence,
    AxisCurrent,
    Circle,
    Contour,
    Currents,
    End,
    Fix,
    Identified,
    Limits,
    Machine,
    Message,
    Messages,
    ProgramRun,
    State,
    Text,
    Timeline,
    Tuned,
    ask_list,
    ask_read,
    ask_write,
    audit,
    audit_sequence,
    check,
    circle,
    commission,
    contour,
    current,
    current_of_recording,
    explain,
    identify,
    learn,
    plan,
    replay,
    run,
    trace,
    trend,
    tune,
    verify,
)
from ._error import Error

__version__ = _version("frictcomp")

__all__ = [
    "Audit",
    "AuditSequence",
    "AxisCurrent",
    "Circle",
    "Contour",
    "Currents",
    "End",
    "Error",
    "Fix",
    "Identified",
    "Limits",
    "Machine",
    "Message",
    "Messages",
    "ProgramRun",
    "State",
    "Text",
    "Timeline",
    "Tuned",
    "ask_list",
    "ask_read",
    "ask_write",
    "audit",
    "audit_sequence",
    "check",
    "circle",
    "commission",
    "contour",
    "current",
    "current_of_recording",
    "explain",
    "identify",
    "learn",
    "plan",
    "replay",
    "run",
    "trace",
    "trend",
    "tune",
    "verify",
]
