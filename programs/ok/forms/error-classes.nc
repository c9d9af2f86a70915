%CLASSES
; The remedy class of an error in every form; 0 lets the program go on.
P1=0
N10 #ERROR [ID=1 RC=0]
N20 #ERROR [RC0 ID1]
N30 #ERROR [ID 1 RC 0]
N40 #ERROR [PV1="RC=2" RC[0] MID=2]
N50 #ERROR [ID=1, RC=[1-1]]
N60 #ERROR [RC=P1 ID=1]
N70 #ERROR [ID=V.L.NUMBER RC P1]
N90 M30
