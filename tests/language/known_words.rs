//! Words known by name, and the messages about unknown ones: R1.59, R1.60, R2.93, R2.94, R2.97.

use crate::support::Bench;

fn said(program: &str) -> String {
    Bench::new().keep_going().said(program)
}

#[test]
fn a_program_of_another_control_is_said_to_be_one() {
    // R2.97
    let parts = (0..40)
        .map(|number| format!("R{number}=5\nN20 IF R{number}>3 GOTOF DONE\nG1 X{number} F100\n"));
    let text = format!("N10 G0 X0 Y0\n{}M30\n", parts.collect::<String>());
    let found = Bench::new().check_all().said(&text);
    let first = found.lines().next().unwrap_or_default();
    assert!(
        first.starts_with("FC326 1:1 this is a program for SINUMERIK, not for an ISG control"),
        "{found}"
    );
    assert!(first.contains("`R0=`, `IF`, `R1=`"), "{first}");
    let codes = found
        .lines()
        .filter(|line| line.starts_with("FC") || line.starts_with("P-ERR"));
    let others = codes.filter(|line| !line.starts_with("FC326") && !line.starts_with("FC905"));
    assert_eq!(others.count(), 20, "{found}");
    assert_eq!(found.matches("FC326").count(), 1);
    let plain = "%\nO1234\nN10 G90 G54 G17\nN20 G43 H1 Z50\nN40 G1 X5 F100\nN50 M30\n";
    assert!(!said(plain).contains("FC326"));
    assert!(!said("P1=1\n$IF P1==1\nR1=1\nR2=2\nR3=3\n$ENDIF\nM30\n").contains("FC326"));
}
