/* A host with its own interpreter: it knows where the axis brackets of a block are, and passes each
 * of them to frictcomp.
 *
 *     own_interpreter START-UP-LIST
 *
 * prints what each bracket changes and which axis is away from its state at the start when the program
 * ends. The states outlive the program, as they do on the control. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "frictcomp.h"

static const char *const PROGRAM[] = {
    "N10 G00 X0 Y0",
    "N20 X[COMP OFF FRICT]",
    "N30 G01 X50 F1500 Y[COMP OFF FRICT]",
    "N40 Y[COMP ON FRICT]",
    "N50 Z[COMP ON FRICT]",
    "N60 M30",
};

static const char *state_name(FrictcompState state)
{
    switch (state) {
    case FRICTCOMP_STATE_UNCONFIGURED: return "unconfigured";
    case FRICTCOMP_STATE_INACTIVE: return "inactive";
    case FRICTCOMP_STATE_ACTIVE: return "active";
    case FRICTCOMP_STATE_INEFFECTIVE: return "ineffective";
    case FRICTCOMP_STATE_UNKNOWN: return "unknown";
    }
    return "unknown";
}

/* Applies one bracket and prints what it changes. Returns 0 where the control would stop. */
static int apply(const FrictcompMachine *machine, FrictcompCompensation *states, const char *bracket)
{
    switch (frictcomp_apply(states, bracket)) {
    case FRICTCOMP_STATUS_OK:
        break;
    case FRICTCOMP_STATUS_NOT_COMP:
        return 1; /* Another command of the axis: not for frictcomp. */
    default: {
        const char *code = frictcomp_last_error_code();
        printf("  %s: %s\n", code != NULL ? code : "error", frictcomp_last_error());
        return 0;
    }
    }
    for (size_t number = 0; number < frictcomp_change_count(states); number++) {
        FrictcompChange change;
        if (frictcomp_change(states, number, &change) == FRICTCOMP_STATUS_OK) {
            const char *axis = frictcomp_machine_axis_name(machine, change.axis);
            printf("  %s: %s -> %s\n", axis, state_name(change.from), state_name(change.to));
        }
    }
    return 1;
}

/* Applies every bracket of a block, `X[...]`. */
static int run_block(const FrictcompMachine *machine, FrictcompCompensation *states, const char *block)
{
    int runs = 1;
    printf("%s\n", block);
    for (const char *open = strchr(block, '['); runs && open != NULL; open = strchr(open + 1, '[')) {
        const char *start = open;
        const char *close = strchr(open, ']');
        char bracket[64];
        while (start > block && start[-1] != ' ') {
            start--;
        }
        if (close == NULL || (size_t)(close - start) + 2 > sizeof bracket) {
            return 0;
        }
        memcpy(bracket, start, (size_t)(close - start) + 1);
        bracket[close - start + 1] = '\0';
        runs = apply(machine, states, bracket);
    }
    return runs;
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: %s START-UP-LIST\n", argv[0]);
        return EXIT_FAILURE;
    }
    FrictcompMachine *machine = frictcomp_machine_read(argv[1]);
    if (machine == NULL) {
        fprintf(stderr, "%s\n", frictcomp_last_error());
        return EXIT_FAILURE;
    }
    for (size_t message = 0; message < frictcomp_machine_message_count(machine); message++) {
        printf("%s\n", frictcomp_machine_message(machine, message));
    }
    FrictcompCompensation *start_up = frictcomp_compensation_new(machine);
    FrictcompCompensation *states = frictcomp_compensation_new(machine);
    if (start_up == NULL || states == NULL) {
        fprintf(stderr, "%s\n", frictcomp_last_error());
        return EXIT_FAILURE;
    }

    for (size_t block = 0; block < sizeof PROGRAM / sizeof PROGRAM[0]; block++) {
        if (!run_block(machine, states, PROGRAM[block])) {
            printf("the control stops here\n");
            break;
        }
    }
    frictcomp_program_end(states);
    for (size_t axis = 0; axis < frictcomp_machine_axis_count(machine); axis++) {
        FrictcompState now = frictcomp_state(states, axis, FRICTCOMP_KIND_FRICT);
        if (now != frictcomp_state(start_up, axis, FRICTCOMP_KIND_FRICT)) {
            printf("left for the next program: %s %s\n", frictcomp_machine_axis_name(machine, axis),
                   state_name(now));
        }
    }

    frictcomp_compensation_free(states);
    frictcomp_compensation_free(start_up);
    frictcomp_machine_free(machine);
    return EXIT_SUCCESS;
}
