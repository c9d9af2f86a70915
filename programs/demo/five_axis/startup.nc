; Start program of the machine: runs once after power on, before production.
; What the operator chose arrives from the PLC in V.E. variables:
;   V.E.WARM_UP      1: move the cold axes before anything else
;   V.E.FRICTION     0: off, 1: linear axes, 2: linear axes and C
;   V.E.PALLET       1 or 2
;   V.E.SERVICE      1: leave everything off, the fitter works on the machine

%L MOVE_AXIS_X
N1 $FOR P1 = 1, 3, 1
N2   G1 X[50 * P1] F3000
N3   X[-50 * P1]
N4 $ENDFOR
N5 X0
N6 M17

%L MOVE_AXIS_Y
N1 $FOR P1 = 1, 3, 1
N2   G1 Y[40 * P1] F3000
N3   Y[-40 * P1]
N4 $ENDFOR
N5 Y0
N6 M17

%L LINEAR_ON
N1 X[COMP ON FRICT] Y[COMP ON FRICT] Z[COMP ON FRICT]
N2 M17

%L LINEAR_OFF
N1 X[COMP OFF FRICT] Y[COMP OFF FRICT] Z[COMP OFF FRICT]
N2 M17

%STARTUP
N10 G17 G71 G90 G94 G53
N20 G74 Z1
N30 G74 X1 Y2
N40 G74 B1 C2

N100 $IF V.E.SERVICE == 1
N110   LL LINEAR_OFF
N120   C[COMP OFF FRICT]
N130   #MSG ["service: friction compensation is off"]
N140   $GOTO [END]
N150 $ENDIF

; --- warm up without compensation: the tables hold for a warm machine
N200 $IF V.E.WARM_UP == 1
N210   LL LINEAR_OFF
N220   G0 Z0
N230   LL MOVE_AXIS_X
N240   LL MOVE_AXIS_Y
N250   $FOR P2 = 30, 90, 30
N260     G0 BP2
N270     B0
N280   $ENDFOR
N290 $ENDIF

; --- what the operator chose
N300 $SWITCH V.E.FRICTION
N310 $CASE 2
N320   C[COMP ON FRICT]
; the linear axes too
N330 $CASE 1
N340   LL LINEAR_ON
N350   $BREAK
N360 $DEFAULT
N370   LL LINEAR_OFF
N380   C[COMP OFF FRICT]
N390 $ENDSWITCH

; --- tell the operator what is really active
N400 V.P.COUNT = V.A.FRICT_COMP_ACTIVE.X + V.A.FRICT_COMP_ACTIVE.Y
N410 V.P.COUNT = V.P.COUNT + V.A.FRICT_COMP_ACTIVE.Z
N420 $IF V.P.COUNT < 3
N430   #MSG ["the linear axes run without friction compensation"]
N440 $ENDIF

; --- pallet
N500 $IF V.E.PALLET == 1
N510   G0 X-400 Y250
N520   M61
N530 $ELSEIF V.E.PALLET == 2
N540   G0 X400 Y250
N550   M62
N560 $ELSE
N570   #MSG ["no pallet is chosen"]
N580 $ENDIF
N590 G0 X0 Y0

[END] G53 G0 Z0
N900 M30
