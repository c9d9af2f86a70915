; wrong: no coupling is active, so none is saved
N10 #SAVE CONFIG [AXLINK]
N20 #LOAD CONFIG [AXLINK]
N30 M30
