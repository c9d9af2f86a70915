/* Every wrong argument that a host can pass, function by function: each call ends with a status and a
 * reason. Run by bindings/c/test, also under valgrind. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "frictcomp.h"

#define CHECK(condition)                                                        \
    do {                                                                        \
        if (!(condition)) {                                                     \
            const char *said = frictcomp_last_error();                          \
            fprintf(stderr, "%d: %s (%s)\n", __LINE__, #condition,              \
                    said != NULL ? said : "no error");                          \
            exit(EXIT_FAILURE);                                                 \
        }                                                                       \
    } while (0)

static int said(const char *words)
{
    const char *error = frictcomp_last_error();
    return error != NULL && strstr(error, words) != NULL;
}

static int is_code(const char *code)
{
    const char *found = frictcomp_last_error_code();
    return found != NULL && strcmp(found, code) == 0;
}

static void machines(const char *folder)
{
    char path[1024];
    CHECK(frictcomp_machine_read(NULL) == NULL && said("`path` is NULL"));
    CHECK(frictcomp_machine_read("") == NULL && said("the path is empty"));
    CHECK(frictcomp_machine_read("not/there.lis") == NULL && said("not/there.lis"));
    CHECK(frictcomp_machine_read("\xff") == NULL && said("UTF-8"));
    CHECK(frictcomp_machine_read(folder) == NULL && said("folder"));

    snprintf(path, sizeof path, "%s/lists/axis_x.lis", folder);
    CHECK(frictcomp_machine_read(path) == NULL && said("start-up list"));

    snprintf(path, sizeof path, "%s/frictcomp.toml", folder);
    FrictcompMachine *machine = frictcomp_machine_read(path);
    CHECK(machine != NULL);
    CHECK(frictcomp_machine_axis_count(machine) == 3);
    CHECK(strcmp(frictcomp_machine_axis_name(machine, 0), "X") == 0);
    CHECK(frictcomp_machine_axis_name(machine, 3) == NULL && said("there is no axis 3"));
    CHECK(frictcomp_machine_message(machine, 1000) == NULL);
    CHECK(frictcomp_machine_enable(machine, "Q") == FRICTCOMP_STATUS_BAD_ARGUMENT);
    CHECK(frictcomp_machine_enable(machine, "Z") == FRICTCOMP_STATUS_OK);
    size_t axis = 99;
    CHECK(frictcomp_machine_find(machine, "Z", &axis) == FRICTCOMP_STATUS_OK && axis == 2);
    CHECK(frictcomp_machine_find(machine, "Z", NULL) == FRICTCOMP_STATUS_BAD_ARGUMENT);
    CHECK(frictcomp_machine_find(machine, "Q", &axis) == FRICTCOMP_STATUS_BAD_ARGUMENT && axis == 2);
    frictcomp_machine_free(machine);

    CHECK(frictcomp_machine_axis_count(NULL) == 0 && said("`machine` is NULL"));
    CHECK(frictcomp_machine_message_count(NULL) == 0 && frictcomp_machine_error_count(NULL) == SIZE_MAX);
    CHECK(frictcomp_compensation_new(NULL) == NULL);
    frictcomp_machine_free(NULL);
    frictcomp_compensation_free(NULL);
}

static void states(void)
{
    FrictcompMachine *machine = frictcomp_machine_unconfigured();
    CHECK(frictcomp_machine_enable(machine, "X") == FRICTCOMP_STATUS_OK);
    CHECK(frictcomp_machine_enable(machine, "x") == FRICTCOMP_STATUS_BAD_ARGUMENT);
    CHECK(frictcomp_machine_enable(machine, "COMP") == FRICTCOMP_STATUS_BAD_ARGUMENT && said("`COMP`"));
    FrictcompCompensation *states = frictcomp_compensation_new(machine);
    frictcomp_machine_free(machine); /* The states work without it. */
    const uint32_t frict = FRICTCOMP_KIND_FRICT;

    CHECK(frictcomp_apply(NULL, "X[COMP ON FRICT]") == FRICTCOMP_STATUS_BAD_ARGUMENT);
    CHECK(frictcomp_apply(states, NULL) == FRICTCOMP_STATUS_BAD_ARGUMENT);
    CHECK(frictcomp_apply(states, "X[COMP OFF \xff]") == FRICTCOMP_STATUS_BAD_ARGUMENT);
    CHECK(frictcomp_apply(states, "") == FRICTCOMP_STATUS_NOT_COMP && said("COMP ON FRICT"));
    CHECK(frictcomp_apply(states, "X[INDP ABS]") != FRICTCOMP_STATUS_OK);
    CHECK(frictcomp_apply(states, "X10 Y[COMP ON FRICT]") == FRICTCOMP_STATUS_FAULTY);
    CHECK(frictcomp_apply(states, "X[COMP OFF FRIKT]") == FRICTCOMP_STATUS_FAULTY);
    CHECK(is_code("FC202") && said("FRICT"));
    CHECK(frictcomp_state(states, 0, frict) == FRICTCOMP_STATE_ACTIVE);

    CHECK(frictcomp_apply(states, "Y[COMP ON FRICT]") == FRICTCOMP_STATUS_REFUSED);
    CHECK(is_code("P-ERR-70495") && said("P-AXIS-00522"));
    CHECK(frictcomp_change_count(states) == 0);
    CHECK(frictcomp_apply(states, "Q[COMP ON FRICT]") == FRICTCOMP_STATUS_REFUSED);
    CHECK(is_code("P-ERR-21947"));

    /* One call is one line and one command, whose execution no switch of the machine decides. */
    CHECK(frictcomp_apply(states, "X[COMP OFF FRICT]\nX[COMP ON FRICT]") == FRICTCOMP_STATUS_FAULTY);
    CHECK(said("give each line by itself"));
    CHECK(frictcomp_apply(states, "G1 X5\nX[COMP OFF FRICT]") == FRICTCOMP_STATUS_FAULTY);
    CHECK(frictcomp_apply(states, "/X[COMP OFF FRICT]") == FRICTCOMP_STATUS_FAULTY && said("without the mark"));
    const char *words = frictcomp_last_error();
    CHECK(frictcomp_state(states, 0, frict) == FRICTCOMP_STATE_ACTIVE);
    CHECK(frictcomp_change_count(states) == 0 && frictcomp_last_error() == words && said("skip"));

    CHECK(frictcomp_apply(states, "X[COMP OFF FRICT]\n") == FRICTCOMP_STATUS_OK);
    FrictcompChange change;
    CHECK(frictcomp_change_count(states) == 1);
    CHECK(frictcomp_change(states, 0, &change) == FRICTCOMP_STATUS_OK);
    CHECK(change.axis == 0 && change.kind == FRICTCOMP_KIND_FRICT);
    CHECK(change.from == FRICTCOMP_STATE_ACTIVE && change.to == FRICTCOMP_STATE_INACTIVE);
    CHECK(frictcomp_change(states, 1, &change) == FRICTCOMP_STATUS_BAD_ARGUMENT);
    CHECK(frictcomp_change(states, 0, NULL) == FRICTCOMP_STATUS_BAD_ARGUMENT);
    CHECK(frictcomp_apply(states, NULL) == FRICTCOMP_STATUS_BAD_ARGUMENT);
    CHECK(frictcomp_change_count(states) == 0);

    /* Neither program end nor reset brings it back. */
    CHECK(frictcomp_program_end(states) == FRICTCOMP_STATUS_OK && frictcomp_change_count(states) == 0);
    CHECK(frictcomp_reset(states) == FRICTCOMP_STATUS_OK);
    CHECK(frictcomp_state(states, 0, frict) == FRICTCOMP_STATE_INACTIVE);

    CHECK(frictcomp_set_state(states, 0, frict, FRICTCOMP_STATE_UNKNOWN) == FRICTCOMP_STATUS_OK);
    CHECK(frictcomp_state(states, 0, frict) == FRICTCOMP_STATE_UNKNOWN);
    CHECK(frictcomp_set_state(states, 0, frict, FRICTCOMP_STATE_ACTIVE) == FRICTCOMP_STATUS_OK);
    CHECK(frictcomp_state(states, 0, frict) == FRICTCOMP_STATE_ACTIVE);
    CHECK(frictcomp_set_state(states, 0, frict, 77) == FRICTCOMP_STATUS_BAD_ARGUMENT);
    CHECK(frictcomp_set_state(states, 1, frict, FRICTCOMP_STATE_ACTIVE) == FRICTCOMP_STATUS_BAD_ARGUMENT);
    CHECK(frictcomp_state(states, 0, 77) == FRICTCOMP_STATE_UNKNOWN && said("not a kind"));
    CHECK(frictcomp_state(states, SIZE_MAX, frict) == FRICTCOMP_STATE_UNKNOWN && said("no axis"));
    CHECK(frictcomp_state(NULL, 0, frict) == FRICTCOMP_STATE_UNKNOWN);

    CHECK(frictcomp_set_coupling(states, 0, FRICTCOMP_COUPLING_ACTIVE) == FRICTCOMP_STATUS_OK);
    CHECK(frictcomp_apply(states, "X[COMP OFF FRICT]") == FRICTCOMP_STATUS_REFUSED);
    CHECK(is_code("P-ERR-21403"));
    CHECK(frictcomp_set_coupling(states, 0, FRICTCOMP_COUPLING_PERHAPS) == FRICTCOMP_STATUS_OK);
    CHECK(frictcomp_apply(states, "X[COMP OFF FRICT]") == FRICTCOMP_STATUS_OK);
    CHECK(frictcomp_state(states, 0, frict) == FRICTCOMP_STATE_UNKNOWN);
    CHECK(frictcomp_set_coupling(states, 0, 9) == FRICTCOMP_STATUS_BAD_ARGUMENT);
    frictcomp_compensation_free(states);
}

/* A state file in which X is off if a value has come from the machine. */
static void possible_states(const char *left)
{
    const uint32_t frict = FRICTCOMP_KIND_FRICT;
    FrictcompMachine *machine = frictcomp_machine_unconfigured();
    CHECK(frictcomp_compensation_read(machine, left) == NULL && said("another machine"));
    CHECK(frictcomp_machine_enable(machine, "X") == FRICTCOMP_STATUS_OK);
    CHECK(frictcomp_machine_enable(machine, "Y") == FRICTCOMP_STATUS_OK);
    CHECK(frictcomp_compensation_read(NULL, left) == NULL && said("`machine` is NULL"));
    CHECK(frictcomp_compensation_read(machine, NULL) == NULL && said("`path` is NULL"));
    CHECK(frictcomp_compensation_read(machine, "not/there.json") == NULL && said("not/there.json"));

    FrictcompCompensation *states = frictcomp_compensation_read(machine, left);
    CHECK(states != NULL);
    frictcomp_machine_free(machine);
    CHECK(frictcomp_state(states, 0, frict) == FRICTCOMP_STATE_UNKNOWN);
    const char *words = frictcomp_possible_states(states, 0, frict);
    CHECK(words != NULL && strstr(words, "inactive if V.E.MATERIAL == 2 (") == words);
    CHECK(strstr(words, "part.nc:1), else active") != NULL);
    CHECK(frictcomp_possible_states(states, 1, frict) == NULL);
    CHECK(frictcomp_possible_states(states, 99, frict) == NULL && said("no axis 99"));
    CHECK(frictcomp_possible_states(states, 0, 77) == NULL && said("not a kind"));
    CHECK(frictcomp_possible_states(NULL, 0, frict) == NULL && said("`compensation` is NULL"));

    /* A state that was known in between is then unknown for another reason. */
    CHECK(frictcomp_apply(states, "X[COMP ON FRICT]") == FRICTCOMP_STATUS_OK);
    CHECK(frictcomp_state(states, 0, frict) == FRICTCOMP_STATE_ACTIVE);
    CHECK(frictcomp_possible_states(states, 0, frict) == NULL);
    CHECK(frictcomp_set_state(states, 0, frict, FRICTCOMP_STATE_UNKNOWN) == FRICTCOMP_STATUS_OK);
    CHECK(frictcomp_possible_states(states, 0, frict) == NULL);
    frictcomp_compensation_free(states);
}

static void long_text(void)
{
    const size_t length = 1000 * 1000;
    FrictcompMachine *machine = frictcomp_machine_unconfigured();
    FrictcompCompensation *states = frictcomp_compensation_new(machine);
    char *text = malloc(length + 1);
    CHECK(text != NULL);
    memset(text, '[', length);
    text[length] = '\0';
    CHECK(frictcomp_apply(states, text) != FRICTCOMP_STATUS_OK && frictcomp_last_error() != NULL);
    free(text);
    frictcomp_compensation_free(states);
    frictcomp_machine_free(machine);
}

int main(int argc, char **argv)
{
    if (argc != 3) {
        fprintf(stderr, "usage: %s FOLDER-OF-THE-DEMO STATE-FILE\n", argv[0]);
        return EXIT_FAILURE;
    }
    CHECK(strchr(frictcomp_version(), '.') != NULL);
    machines(argv[1]);
    states();
    possible_states(argv[2]);
    long_text();
    puts("every mistake has its status");
    return EXIT_SUCCESS;
}
