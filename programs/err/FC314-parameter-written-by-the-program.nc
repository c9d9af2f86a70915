%SETUP
; wrong: the program writes P-AXIS-00522 itself
N10 #MACHINE DATA [AX=X AXPARAM "lr_param.frict_comp 0"]
N20 G01 X50 F1500
N30 M30
