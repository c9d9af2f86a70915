%REGIONS
N10 G0 X0 (a (nested) comment) Y0
#COMMENT BEGIN
N20 X[COMP OFF FRICT]
N30 this is no NC code [
#COMMENT END
N40 V.P.TEXT = "; no comment ( either"
N50 M30
