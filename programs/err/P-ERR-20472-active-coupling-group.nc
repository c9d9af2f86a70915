; wrong: group 1 is active
N10 #SET AX LINK [1, Y=X]
N20 #ENABLE AX LINK [1]
N30 #SET AX LINK [1, Z=X]
N40 M30
