%FRICTION
N15 X[COMP ON FRICT] ;Activates X axis
N25 Y[COMP OFF FRICT] ;Deactivates Y axis
N35 X22 Y33 Z44
N45 X[COMP OFF FRICT] ;Deactivates X axis
N55 M30 ;Program end
