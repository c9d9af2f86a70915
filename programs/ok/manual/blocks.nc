( head comment (nested) )
%BLOCKS ; the main program
N10G1X100Y-.5F200
/N20 X1
/3 N30 X2
N 40 X 3
N[4*10+10] X4
N060 G01 X+5. Y+.25
N70 X5 ; end
N80 X'16#1F' Y'2#101'
#COMMENT BEGIN
N90 anything [ goes
#COMMENT END
N100 X=7 Y = 8
N110 M30
