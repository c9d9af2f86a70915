%LOWER
; Keywords and address letters in lower case; axis names stay as they are
n10 g90 g17
n20 X[comp off frict]
n30 g01 X50 f1500
n40 X[comp on frict]
n50 m30
