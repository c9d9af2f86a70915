; Housing cover 4711, side A: face, pocket, circular seat, bolt circle.
; The finishing passes run with friction compensation of the plane's axes; roughing
; and drilling run without it, because the tables hold for low feed only.

%L TOOLCHANGE
; P1: tool number, P2: speed
N1 M5 M9
N2 G53 G0 Z0
N3 TP1 M6
N4 DP1
N5 G54 SP2 M3
N6 M17

%L FINE_ON
N1 X[COMP ON FRICT] Y[COMP ON FRICT]
N2 #HSC ON
N3 M17

%L FINE_OFF
N1 #HSC OFF
N2 X[COMP OFF FRICT] Y[COMP OFF FRICT]
N3 M17

%L SEAT
; Circular seat of radius P10 in the middle; P11: feed, P12: 1 for the fine pass.
N1 $IF P12 == 1
N2   LL FINE_ON
N3 $ENDIF
N4 G0 X0 Y0
N5 G1 Z-6 F300
N6 G41 XP10 Y0 FP11
N7 G3 XP10 Y0 I-P10 J0
N8 G40 X0 Y0
N9 G0 Z5
N10 $IF P12 == 1
N11   LL FINE_OFF
N12 $ENDIF
N13 M17

%L POCKET
; Rectangular pocket of P20 by P21 down to P22, P23 deep each time.
N1 P24 = 0
N2 $WHILE P24 > P22
N3   P24 = P24 - P23
N4   $IF P24 < P22
N5     P24 = P22
N6   $ENDIF
N7   G1 X0 Y0 F1200
N8   ZP24 F250
N9   G1 X[P20 / 2] F1200
N10  Y[P21 / 2]
N11  X[-P20 / 2]
N12  Y[-P21 / 2]
N13  X[P20 / 2]
N14  Y0
N15 $ENDWHILE
N16 G0 Z5
N17 M17

%L POCKET_FINE
; One fine pass round the pocket of P20 by P21 at depth P22.
N1 LL FINE_ON
N2 G0 X[P20 / 2 - 4] Y0
N3 G1 ZP22 F250
N4 G41 X[P20 / 2] F600
N5 Y[P21 / 2]
N6 X[-P20 / 2]
N7 Y[-P21 / 2]
N8 X[P20 / 2]
N9 Y0
N10 G40 X[P20 / 2 - 4]
N11 G0 Z5
N12 LL FINE_OFF
N13 M17

%COVER_A
N10 G17 G71 G90 G94 G40
N20 X[COMP OFF FRICT] Y[COMP OFF FRICT] Z[COMP OFF FRICT] ;roughing does without

; --- face, cutter head 63 mm
N100 P1=1 P2=2200
N110 LL TOOLCHANGE
N120 G0 X-90 Y-30 Z2 M8
N130 $FOR P3 = -30, 30, 30
N140   G0 YP3
N150   G1 Z0 F800
N160   X90 F1500
N170   G0 Z2
N180   X-90
N190 $ENDFOR

; --- pocket, end mill 12 mm
N200 P1=2 P2=5500
N210 LL TOOLCHANGE
N220 P20=64 P21=40 P22=-12 P23=4
N230 G0 X0 Y0 Z5 M8
N240 LL POCKET

; --- circular seat, rough then fine
N300 P10=14.8 P11=900 P12=0
N310 LL SEAT
N320 P1=3 P2=7000
N330 LL TOOLCHANGE
N340 G0 X0 Y0 Z5 M8
N350 P10=15 P11=450 P12=1
N360 LL SEAT
N370 LL POCKET_FINE

; --- bolt circle, drill 6.8 mm
N400 P1=4 P2=2800
N410 LL TOOLCHANGE
N420 G0 Z5 M8
N430 $FOR P4 = 0, 5, 1
N440   G0 X[40 * COS[P4 * 60]] Y[40 * SIN[P4 * 60]]
N450   G1 Z-18 F280
N460   G04 0.2
N470   G0 Z5
N480 $ENDFOR

; --- leave the machine as it was found
N900 M9 M5
N910 G53 G0 Z0
N920 X[COMP ON FRICT] Y[COMP ON FRICT] Z[COMP ON FRICT]
N930 M30
