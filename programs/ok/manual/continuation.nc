%CONT
N10 G01 \
N20 X10 \
; comment between
    Y20 F[100 \
    * 2]
N30 X[ \
COMP \
OFF FRICT \
]
N40 L CYCLE \
  [NAME=own.cyc \
   @P1=1 @P2=2 @P3=3 \
  ]
N50 M30
