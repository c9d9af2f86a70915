; wrong: the label has no brackets
N10 $GOTO END
N20 [END] M30
