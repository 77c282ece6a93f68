# Completion of armctl for bash. The program itself is asked what could stand at the cursor, so this file does not age.
_armctl() {
    local LC_ALL=C line more=
    COMPREPLY=()
    while IFS= read -r line; do
        COMPREPLY+=("${line:1}")
        more=${line:0:1}
    done < <(
        ARMCTL_COMPLETE="bash ${COMP_TYPE:-9} ${COLUMNS:-80}" \
            armctl -- "${COMP_LINE:0:COMP_POINT}" "$2" 2>/dev/null
    )
    # Where more must follow, no blank does.
    if [[ ${#COMPREPLY[@]} -eq 1 && $more == - ]]; then
        compopt -o nospace 2>/dev/null
    fi
}
complete -o bashdefault -o default -o nosort -F _armctl armctl yerc yrcx toyo 2>/dev/null ||
    complete -o bashdefault -o default -F _armctl armctl yerc yrcx toyo
