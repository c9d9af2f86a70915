; wrong: no M function has a number above 1000
N10 M1001
N20 M30
