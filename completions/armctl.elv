# Completion of armctl for elvish. The program itself is asked what could stand at the cursor, so this file does not age.
for name [armctl yerc yrcx toyo] {
    set edit:completion:arg-completer[$name] = {|@words|
        env ARMCTL_COMPLETE=elvish armctl -- $@words 2>/dev/null
    }
}
