%WORK
; wrong: D uses A 512 times, and the loop uses D 400 times
N10 "A" = "(the function of the pattern, as it was found on the machine by the second shift) H15"
N20 "B" = "\"A\" \"A\" \"A\" \"A\" \"A\" \"A\" \"A\" \"A\""
N30 "C" = "\"B\" \"B\" \"B\" \"B\" \"B\" \"B\" \"B\" \"B\""
N40 "D" = "\"C\" \"C\" \"C\" \"C\" \"C\" \"C\" \"C\" \"C\""
N50 $FOR P1=1,400,1
N60 "D"
N70 $ENDFOR
N80 M30
