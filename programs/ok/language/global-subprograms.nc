%GLOBAL
N10 L contour.cyc
N20 L "contour.cyc" (a name in quotes)
N30 "FILE" = "contour.cyc"
N40 L "FILE"
N50 M30
