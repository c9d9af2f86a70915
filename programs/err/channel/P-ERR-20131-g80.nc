; wrong: the channel list names no program for G80
N10 G80
N20 M30
