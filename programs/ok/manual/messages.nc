%MSG
#VAR
V.L.COUNT = 3
#ENDVAR
N10 #MSG ["part %d of %f done", V.L.COUNT, 12.5]
N20 #MSG SYN HMI ["waiting (for operator)"]
N30 #FILE NAME [MSG="result.txt"]
N40 #MSG SAVE ["V.L.COUNT =%d", V.L.COUNT]
N50 #MSG SAVE EXCLUSIVE ["100%%; not a comment"]
N60 #ERROR [ID=455 RC=0 PV1=10 PV2=V.L.COUNT]
N70 #INFO ["x"]
N80 #MSG INFO ["%s", "text with \"quotes\""]
N90 M30
