; before the program
% TEXT (the rest of the line is none of the name)
(a comment ( with another ) inside)
N10 X0 (in between) Y0 ; to the end
N20 X0 ( not closed
#COMMENT BEGIN
anything at all $IF #FOO [
#COMMENT END
/N30 X1
/2 N40 X1
/10 N50 X1
N60 \
  X1 \

; a remark
  N65 Y1 \
  F1000
N70G1X2Y2F500
N80 G1	X3	Y3
N[90] X4
N1000 X5
N5 X6
N100: X7
[START] X8
[_UNDER_1]
N120 M30
