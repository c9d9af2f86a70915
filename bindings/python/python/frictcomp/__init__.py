"""Dry runs of ISG and TwinCAT CNC programs with an eye on friction compensation.

``run`` executes programs without a machine and gives their timeline: which axis has friction
compensation active after each block. The timeline is a table that pandas, polars and DuckDB take
without a copy. ``check`` gives the messages of whole folders, ``audit`` what the order of programs
does. ``current``, ``contour``, ``circle``, ``tune`` and ``identify`` are about the compensation itself.

    import frictcomp, polars
    timeline = frictcomp.run("part.nc")
    polars.DataFrame(timeline)

A state that depends on a value which only the machine knows is ``"unknown"``: a value of its own,
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
    audit,
    audit_sequence,
    check,
    circle,
    contour,
    current,
    current_of_recording,
    identify,
    run,
    tune,
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
    "audit",
    "audit_sequence",
    "check",
    "circle",
    "contour",
    "current",
    "current_of_recording",
    "identify",
    "run",
    "tune",
]
