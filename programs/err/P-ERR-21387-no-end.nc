; wrong: where does the conditional part end?
#IF TRUE
N10 X10
N20 M30
