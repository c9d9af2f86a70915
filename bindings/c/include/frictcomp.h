/* Friction compensation of ISG and TwinCAT CNC controls, for hosts with their own interpreter.
 *
 * A handle is used by one thread at a time; different handles may be used by different threads. Texts
 * that are handed over are UTF-8 and end with NUL. No function throws, ends the process or keeps a pointer
 * that it was handed. What was made from a machine no longer needs it.
 *
 * Made from the functions of bindings/c: do not edit. */

#ifndef FRICTCOMP_H
#define FRICTCOMP_H

#include <stddef.h>
#include <stdint.h>

/* The version of this header; `frictcomp_version` is that of the library. */
#define FRICTCOMP_VERSION_MAJOR 0
#define FRICTCOMP_VERSION_MINOR 1
#define FRICTCOMP_VERSION_PATCH 0
#define FRICTCOMP_VERSION "0.1.0"

// Result of a call.
typedef enum {
    // Success.
    FRICTCOMP_STATUS_OK = 0,
    // The control refuses the command with its own error; nothing is changed.
    FRICTCOMP_STATUS_REFUSED = 1,
    // The text is a bracket or a word that does not concern COMP; nothing is changed.
    FRICTCOMP_STATUS_NOT_COMP = 2,
    // The text is a COMP command with a mistake, or more than one command or line; nothing is changed.
    FRICTCOMP_STATUS_FAULTY = 3,
    // An argument is missing, is not UTF-8, or names something that does not exist.
    FRICTCOMP_STATUS_BAD_ARGUMENT = 4,
    // A file cannot be read or used.
    FRICTCOMP_STATUS_NO_MACHINE = 5,
    // A mistake in frictcomp itself; the handle that was used should be freed.
    FRICTCOMP_STATUS_INTERNAL = 6,
} FrictcompStatus;

// The state of a kind of compensation on an axis.
typedef enum {
    // The axis parameters do not configure it.
    FRICTCOMP_STATE_UNCONFIGURED = 0,
    // Switched off.
    FRICTCOMP_STATE_INACTIVE = 1,
    // Switched on and working.
    FRICTCOMP_STATE_ACTIVE = 2,
    // Switched on without effect, because its value list was not accepted.
    FRICTCOMP_STATE_INEFFECTIVE = 3,
    // Known only to the machine.
    FRICTCOMP_STATE_UNKNOWN = 4,
} FrictcompState;

// A kind of axis compensation that COMP switches.
typedef enum {
    // `BACKLASH`
    FRICTCOMP_KIND_BACKLASH = 0,
    // `CROSS`
    FRICTCOMP_KIND_CROSS = 1,
    // `PLANE`
    FRICTCOMP_KIND_PLANE = 2,
    // `LEAD`
    FRICTCOMP_KIND_LEAD = 3,
    // `TEMP`
    FRICTCOMP_KIND_TEMP = 4,
    // `FRICT`
    FRICTCOMP_KIND_FRICT = 5,
    // `CROSSTALK`
    FRICTCOMP_KIND_CROSSTALK = 6,
} FrictcompKind;

// Membership of an axis in a coupling, in which the control refuses COMP.
typedef enum {
    // Not a member of a coupling.
    FRICTCOMP_COUPLING_NONE = 0,
    // Member of a coupling.
    FRICTCOMP_COUPLING_ACTIVE = 1,
    // Possible member, known only to the machine: the state after COMP is unknown.
    FRICTCOMP_COUPLING_PERHAPS = 2,
} FrictcompCoupling;

// The state of every compensation on every axis of a machine.
typedef struct FrictcompCompensation FrictcompCompensation;

// A machine: its axes, and what the lists of the control say about their compensation.
typedef struct FrictcompMachine FrictcompMachine;

// One state that a call changed.
typedef struct {
    // The position of the axis in the machine.
    size_t axis;
    // The kind of compensation.
    FrictcompKind kind;
    // The state before.
    FrictcompState from;
    // The state now.
    FrictcompState to;
} FrictcompChange;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The version of frictcomp, as `0.1.0`. The text is always valid.
const char *frictcomp_version(void);

// Returns why the last failing call of this thread failed, in one sentence; NULL if none has failed yet. A
// call that succeeds changes nothing here: read it after a call that reports a failure. The text is valid
// until the next call of this thread that fails.
const char *frictcomp_last_error(void);

// The number of that error, such as `P-ERR-70495` for an error of the control or `FC202` for one of
// frictcomp; NULL if it has none. The text is valid until the next call of this thread that fails.
const char *frictcomp_last_error_code(void);

// Reads the machine from a start-up list of the control, with every list that it names, or from a
// `frictcomp.toml`. The path is UTF-8. NULL if that is not possible. A machine is made despite
// errors in the lists: check `frictcomp_machine_error_count`.
FrictcompMachine *frictcomp_machine_read(const char *path);

// A machine without lists: the axes X Y Z A B C U V W, none of which has compensation until
// `frictcomp_machine_enable` assumes it.
FrictcompMachine *frictcomp_machine_unconfigured(void);

// Assumes friction compensation on an axis: P-AXIS-00522 is 1 and its value list is accepted. What was
// made from the machine before does not change. A machine without lists gets an axis that it does not have
// if a program can name it: a capital A, B, C, U, V, W, X, Y, Z or Q, then capitals, digits or `_`, but not
// `Q` alone, `ALL` or a word of the COMP command; from lists, only their axes are accepted.
FrictcompStatus frictcomp_machine_enable(FrictcompMachine *machine,
                                         const char *axis);

// Returns the number of axes of the machine; 0 for NULL.
size_t frictcomp_machine_axis_count(const FrictcompMachine *machine);

// The name of an axis by its position; NULL if there is none. The text is valid until the machine
// is changed or freed.
const char *frictcomp_machine_axis_name(const FrictcompMachine *machine, size_t axis);

// Writes the position of an axis to `axis`, by its name.
FrictcompStatus frictcomp_machine_find(const FrictcompMachine *machine,
                                       const char *name,
                                       size_t *axis);

// Returns the number of messages about the lists of the machine; 0 for NULL.
size_t frictcomp_machine_message_count(const FrictcompMachine *machine);

// Returns the number of errors among the messages: where there is one, the control would not start with these
// lists, or would reject one of them. `SIZE_MAX` for NULL.
size_t frictcomp_machine_error_count(const FrictcompMachine *machine);

// A message about the lists, `file:line:column: severity[code] words`; NULL if there is none. The
// text is valid until the machine is freed.
const char *frictcomp_machine_message(const FrictcompMachine *machine, size_t message);

// Frees a machine; NULL is ignored. What was made from it remains valid.
void frictcomp_machine_free(FrictcompMachine *machine);

// The states of every compensation on every axis after a start of the control; NULL if that is not
// possible.
FrictcompCompensation *frictcomp_compensation_new(const FrictcompMachine *machine);

// The states that dry runs left in a state file of `frictcomp run --state`, on the same machine; NULL
// if that is not possible. The path is UTF-8.
FrictcompCompensation *frictcomp_compensation_read(const FrictcompMachine *machine,
                                                   const char *path);

// Frees the states; NULL is ignored.
void frictcomp_compensation_free(FrictcompCompensation *compensation);

// Applies one COMP command on one line, such as `X[COMP OFF FRICT]`. More than one command or line, and a
// skip mark, whose switch only the machine has, are `FRICTCOMP_STATUS_FAULTY`. If the control refuses it, nothing is changed,
// `FRICTCOMP_STATUS_REFUSED` is returned, and `frictcomp_last_error_code` is the control's error.
FrictcompStatus frictcomp_apply(FrictcompCompensation *compensation,
                                const char *command);

// Applies the end of a program: friction compensation does not change.
FrictcompStatus frictcomp_program_end(FrictcompCompensation *compensation);

// Applies a reset of the control.
FrictcompStatus frictcomp_reset(FrictcompCompensation *compensation);

// Sets a state that the host knows from elsewhere, such as the previous job. `kind` is a
// `FrictcompKind`; `state` is active, inactive or unknown.
FrictcompStatus frictcomp_set_state(FrictcompCompensation *compensation,
                                    size_t axis,
                                    uint32_t kind,
                                    uint32_t state);

// Sets whether an axis takes part in a coupling, a `FrictcompCoupling`.
FrictcompStatus frictcomp_set_coupling(FrictcompCompensation *compensation,
                                       size_t axis,
                                       uint32_t coupling);

// The state of a kind of compensation, a `FrictcompKind`, on an axis. What does not exist is unknown, and
// `frictcomp_last_error` says why.
FrictcompState frictcomp_state(const FrictcompCompensation *compensation,
                               size_t axis,
                               uint32_t kind);

// The states that are possible for a kind of compensation, a `FrictcompKind`, on an axis, with the
// conditions that lead to each: `inactive if V.E.MATERIAL == 2 (part.nc:12), else active`. NULL if the
// state is known, or unknown for a reason other than a condition of a dry run. The text is
// valid until the handle is changed or freed.
const char *frictcomp_possible_states(const FrictcompCompensation *compensation,
                                      size_t axis,
                                      uint32_t kind);

// Returns the number of states that the last call with this handle changed; 0 for NULL.
size_t frictcomp_change_count(const FrictcompCompensation *compensation);

// Writes a change of the last call with this handle to `change`.
FrictcompStatus frictcomp_change(const FrictcompCompensation *compensation,
                                 size_t number,
                                 FrictcompChange *change);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* FRICTCOMP_H */
