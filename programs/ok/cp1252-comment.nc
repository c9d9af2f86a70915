%UMLAUT
; Ü-Achse läuft
N10 G01 X50 F1500 (Vorschub für Stahl, 20 °C)
N20 M30 ;Ende – fertig
