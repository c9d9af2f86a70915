%OPERATORS
N10 P1 = 1 + 2 * 3 - 4 / 2
N20 P2 = -2**2
N30 P3 = 2**3**2
N40 P4 = 11 MOD 3
N50 P5 = 6 & 3 | 8 ^ 1
N60 P6 = INV['16#FFFFFFF0']
N70 P7 = 1 < 2 && 3 >= 3 || NOT[1]
N80 P8 = 1 XOR 0
N90 P9 = [P1 != 0] + [P2 == -4] + [P3 > 500] + [P4 <= 2]
$IF P1 == 5 && P2 == -4 && P3 == 512 && P4 == 2 && P6 == 15 && P9 == 4
N100 X[COMP OFF FRICT]
$ENDIF
N110 X[COMP ON FRICT]
N120 M30
