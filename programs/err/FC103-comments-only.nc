; A file without a block

( X[COMP OFF FRICT] )
; X[COMP OFF FRICT]
