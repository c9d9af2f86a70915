%PALLET_CHANGER
(Requests the next pallet and machines it with compensation as the control starts)
N10 G90 G17 G71
N20 G74 X1 Y2 Z3
N30 G00 Z200
N40 G00 X0 Y400
N50 V.E.PAL_NO = 2                (pallet that is wanted)
N60 V.E.PAL_REQ = 1               (request to the PLC)
N70 $WHILE V.E.PAL_REQ == 1       (the PLC resets it when the pallet is clamped)
N80 #TIME 0.1
N90 $ENDWHILE
N100 $IF V.E.PAL_STATE != 0       (fault of the changer)
N110 #MSG ["PALLET CHANGER FAULT"]
N120 M0
N130 $ENDIF
N140 G54 M3 S6000
N150 G00 X10 Y10
N160 G01 Z-2 F800
N170 G01 X90 F1500
N180 G01 Y90
N190 G01 X10
N200 G01 Y10
N210 G00 Z200 M5
N220 M30
