@echo off
rem Makes yerc.exe, yrcx.exe and toyo.exe beside armctl.exe. They are hard links and need no space.
rem After an update, start this file again.
cd /d "%~dp0"
for %%n in (yerc yrcx toyo) do (
    if exist %%n.exe del %%n.exe
    mklink /H %%n.exe armctl.exe
)
