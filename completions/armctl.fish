# Completion of armctl for fish. The program itself is asked what could stand at the cursor, so this file does not age.
function __armctl_complete
    set -lx ARMCTL_COMPLETE fish
    armctl -- (commandline --current-process --tokenize --cut-at-cursor) (commandline --current-token --cut-at-cursor) 2>/dev/null
end
for name in armctl yerc yrcx toyo
    complete --command $name --keep-order --no-files --arguments '(__armctl_complete)'
end
