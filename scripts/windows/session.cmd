@echo off
rem The first steps of a user in `cmd`: ten commands in a folder of programs, %1. The first that does not
rem do what it should ends the session with the number of its step.
cd /d "%~1"
if not exist mill exit /b 99

frictcomp --version
if errorlevel 1 exit /b 1

frictcomp init mill
if errorlevel 1 exit /b 2

frictcomp check --enable X mill\*.nc > check.txt
if not errorlevel 1 exit /b 3
findstr /c:"mill/wrong.nc:2:15" check.txt > nul
if errorlevel 1 exit /b 3

frictcomp check --enable X --fix --fail-on error mill\mended.nc > fixed.txt
if errorlevel 1 exit /b 4

frictcomp run --enable X --state state.json MILL\FIRST.NC > first.txt
if errorlevel 1 exit /b 5
if not exist state.json exit /b 5

frictcomp run --enable X --state state.json --format ndjson -o next.ndjson mill\next.nc
if errorlevel 1 exit /b 6
findstr mill/next.nc next.ndjson > nul
if errorlevel 1 exit /b 6

frictcomp audit --enable X mill > audit.txt
if errorlevel 2 exit /b 7

frictcomp golden --update --enable X mill\first.nc
if errorlevel 1 exit /b 8

frictcomp golden --enable X mill\first.nc
if errorlevel 1 exit /b 9

frictcomp circle --format csv -o circle.csv
if errorlevel 1 exit /b 10
exit /b 0
