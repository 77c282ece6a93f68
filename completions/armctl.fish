# Print an optspec for argparse to handle cmd's options that are independent of any subcommand.
function __fish_armctl_global_optspecs
    string join \n sim t/target= r/robot= all tag= config= o/format= json jq= q/quiet v/verbose color= trace= y/yes dry-run on-interrupt= timeout= retries= encoding= no-session watch= count= until= for= h/help V/version
end

function __fish_armctl_needs_command
    # Figure out if the current invocation already has a command.
    set -l cmd (commandline -opc)
    set -e cmd[1]
    argparse -s (__fish_armctl_global_optspecs) -- $cmd 2>/dev/null
    or return
    if set -q argv[1]
        # Also print the command, so this can be used to figure out what it is.
        echo $argv[1]
        return 1
    end
    return 0
end

function __fish_armctl_using_subcommand
    set -l cmd (__fish_armctl_needs_command)
    test -z "$cmd"
    and return 1
    contains -- $cmd[1] $argv
end

complete -c armctl -n "__fish_armctl_needs_command" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_needs_command" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_needs_command" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_needs_command" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_needs_command" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_needs_command" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_needs_command" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_needs_command" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_needs_command" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_needs_command" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_needs_command" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_needs_command" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_needs_command" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_needs_command" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_needs_command" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_needs_command" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_needs_command" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_needs_command" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_needs_command" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_needs_command" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_needs_command" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_needs_command" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_needs_command" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_needs_command" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_needs_command" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_needs_command" -s V -l version -d 'Print version'
complete -c armctl -n "__fish_armctl_needs_command" -f -a "yerc" -d 'Yaskawa FS100 / DX200 over the high-speed Ethernet server (UDP)'
complete -c armctl -n "__fish_armctl_needs_command" -f -a "yrcx" -d 'OMRON / Yamaha YRCX over EtherNet/IP'
complete -c armctl -n "__fish_armctl_needs_command" -f -a "toyo" -d 'Toyo over RS-232C host communication'
complete -c armctl -n "__fish_armctl_needs_command" -f -a "status" -d 'One line a robot: reachable, mode, servo, state, alarm, position'
complete -c armctl -n "__fish_armctl_needs_command" -f -a "robots" -d 'The inventory: list, show, add, remove; check and discover'
complete -c armctl -n "__fish_armctl_needs_command" -f -a "session" -d 'Hold a link for all commands that follow: open, list, close'
complete -c armctl -n "__fish_armctl_needs_command" -f -a "sim" -d 'Serve the simulators on real sockets'
complete -c armctl -n "__fish_armctl_needs_command" -f -a "decode" -d 'Explain bytes of the line'
complete -c armctl -n "__fish_armctl_needs_command" -f -a "explain" -d 'What an error or alarm code means and what to do'
complete -c armctl -n "__fish_armctl_needs_command" -f -a "completions" -d 'Print the completion script of a shell'
complete -c armctl -n "__fish_armctl_needs_command" -f -a "man" -d 'Write the man pages'
complete -c armctl -n "__fish_armctl_needs_command" -f -a "schema" -d 'Print the JSON Schema of a report'
complete -c armctl -n "__fish_armctl_needs_command" -f -a "help" -d 'Explain a topic, or a command'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -f -a "status" -d 'Mode, cycle, servo, hold, alarm: every status bit'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -f -a "alarm" -d 'Alarms: list, history, reset, cancel'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -f -a "job" -d 'Jobs: show, select, start'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -f -a "file" -d 'Files: list, get, put, delete, diff, backup, restore, cmos'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -f -a "position" -d 'Where a control group stands: pulses, base coordinates, form'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -f -a "axes" -d 'The axes of each control group'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -f -a "position-error" -d 'How far each axis is from where it should be'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -f -a "torque" -d 'The torque of each axis'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -f -a "var" -d 'Variables: get, set, dump, restore'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -f -a "io" -d 'Signals: get, set'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -f -a "register" -d 'Registers: get, set'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -f -a "servo" -d 'Switch servo power'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -f -a "hold" -d 'Hold the robot, or let it go on'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -f -a "hlock" -d 'Lock or unlock the pendant and the operation signals'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -f -a "cycle" -d 'Choose step, one cycle or continuous'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -f -a "say" -d 'Show a message on the pendant'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -f -a "move" -d 'Move a robot or station'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -f -a "hours" -d 'Running times: power, servo, playback, motion, applications'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -f -a "info" -d 'Software version, robot models, parameters'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and not __fish_seen_subcommand_from status alarm job file position axes position-error torque var io register servo hold hlock cycle say move hours info raw" -f -a "raw" -d 'Send any request and explain the answer'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from status" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from status" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from status" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from status" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from status" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from status" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from status" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from status" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from status" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from status" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from status" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from status" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from status" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from status" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from status" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from status" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from status" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from status" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from status" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from status" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from status" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from status" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from status" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from status" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from status" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -f -a "list" -d 'The alarms that are present'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -f -a "history" -d 'The alarms of the past, the latest of each class first'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -f -a "reset" -d 'Reset the alarm'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from alarm" -f -a "cancel" -d 'Cancel the error'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -f -a "show" -d 'What runs: job, line, step and speed override of a task'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -f -a "select" -d 'Choose the job that a start will run'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from job" -f -a "start" -d 'Start the selected job'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -f -a "list" -d 'List the files on the controller'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -f -a "get" -d 'Fetch files'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -f -a "put" -d 'Send files'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -f -a "delete" -d 'Delete files on the controller'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -f -a "diff" -d 'Compare a file on the controller with a local one'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -f -a "backup" -d 'Fetch every file into a folder, with sizes and hashes'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -f -a "restore" -d 'Send the files of a backup back'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from file" -f -a "cmos" -d 'Have the controller make its batch backup (CMOSBK.BIN), and fetch it'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -l group -d 'Control group: R1 …, B1 …, S1 …' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -l coordinates -d 'In pulses, in base coordinates (robots only), or both [default: what the group has]' -r -f -a "pulse\t'Pulses of each axis'
base\t'X Y Z Rx Ry Rz in base coordinates'
both\t'Both'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -l group -d 'Control group: R1 …, B1 …, S1 …, or all that exist' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from axes" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -l group -d 'Control group: R1 …, B1 …, S1 …' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from position-error" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -l group -d 'Control group: R1 …, B1 …, S1 …' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from torque" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -f -a "get" -d 'Read variables: B0 I1..I20 D5 R3 S2 P10 BP1 EX1'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -f -a "set" -d 'Write variables: B0=255 R3=1.5 S7=HELLO P1=base:x=…'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -f -a "dump" -d 'Save variables to a JSON file'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from var" -f -a "restore" -d 'Write back what a dump holds'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -f -a "get" -d 'Read signals: 20010, #20010..#20017, or --group 2001'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from io" -f -a "set" -d 'Switch network inputs: 27010=on, or --group 2701=0xA5'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -f -a "get" -d 'Read registers: 0 to 999'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from register" -f -a "set" -d 'Write registers: 0 to 559'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from servo" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from servo" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from servo" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from servo" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from servo" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from servo" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from servo" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from servo" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from servo" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from servo" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from servo" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from servo" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from servo" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from servo" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from servo" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from servo" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from servo" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from servo" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from servo" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from servo" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from servo" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from servo" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from servo" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from servo" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from servo" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hold" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hold" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hold" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hold" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hold" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hold" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hold" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hold" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hold" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hold" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hold" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hold" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hold" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hold" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hold" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hold" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hold" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hold" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hold" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hold" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hold" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hold" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hold" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hold" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hold" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hlock" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hlock" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hlock" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hlock" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hlock" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hlock" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hlock" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hlock" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hlock" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hlock" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hlock" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hlock" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hlock" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hlock" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hlock" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hlock" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hlock" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hlock" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hlock" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hlock" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hlock" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hlock" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hlock" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hlock" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hlock" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from cycle" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from cycle" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from cycle" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from cycle" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from cycle" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from cycle" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from cycle" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from cycle" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from cycle" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from cycle" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from cycle" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from cycle" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from cycle" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from cycle" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from cycle" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from cycle" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from cycle" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from cycle" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from cycle" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from cycle" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from cycle" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from cycle" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from cycle" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from cycle" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from cycle" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from say" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from say" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from say" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from say" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from say" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from say" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from say" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from say" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from say" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from say" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from say" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from say" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from say" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from say" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from say" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from say" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from say" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from say" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from say" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from say" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from say" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from say" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from say" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from say" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from say" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -f -a "joint" -d 'To a position, each axis on its own way'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -f -a "linear" -d 'To a position, in a straight line'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -f -a "relative" -d 'By a distance, in a straight line'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from move" -f -a "pulse" -d 'To pulses: joint, linear'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -l group -d 'Servo, playback and motion time of a robot or station; all: every counter that exists' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -l application -d 'Operation time of an application' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from hours" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -l group -d 'A robot or station, or all that exist with their applications [default: all]' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -l application -d 'An application' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from info" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -l command -d 'Command number, such as 0x72' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -l instance -d 'Instance: which of the things that the command addresses' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -l attribute -d 'Attribute: which field; 0 for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -l service -d 'Service: 0x01 or 0x0E read, 0x02 or 0x10 write, 0x33 and 0x34 read and write several' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -l data -d 'Data of the request in hexadecimal; blanks, colons and 0x may stand between' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -l file -d 'Ask the file server instead of the robot server'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -l check -d 'Refuse here what the manuals do not list for this model'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yerc; and __fish_seen_subcommand_from raw" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "status" -d 'Signals, servos and position in words'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "move" -d 'Move a robot to a point or to coordinates'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "movei" -d 'Move a robot by distances'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "movet" -d 'Move a robot to a point in the coordinates of its tool'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "drive" -d 'Move one axis to a place'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "drivei" -d 'Move one axis by a distance'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "pallet" -d 'Move a robot to a place on a pallet'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "push" -d 'Push with one axis'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "jog" -d 'Move an axis until it is stopped'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "inch" -d 'Move an axis by the inching distance'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "inch-distance" -d 'Set the inching distance'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "teach" -d 'Store where the robot is in a point'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "origin" -d 'Return to origin'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "abs-reset" -d 'Reset the absolute position of an axis'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "speed" -d 'Set a speed'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "shift" -d 'The shift of the coordinates'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "hand" -d 'The hand at the robot\'s end'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "arm" -d 'The hand system of the arm'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "torque-limit" -d 'Limit the torque of an axis'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "servo" -d 'Switch servos on or off, or release their brakes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "motor" -d 'Switch motor power on or off'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "point" -d 'Points'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "comment" -d 'Comments of points'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "pallet-data" -d 'Pallets'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "shift-data" -d 'Shifts of coordinates'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "hand-data" -d 'Hands'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "point-calc" -d 'Points and shifts that the controller computes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "var" -d 'Static variables SGI and SGR'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "param" -d 'Parameters of robots and axes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "port" -d 'Ports of eight signals'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "program" -d 'Programs and their tasks'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "info" -d 'Versions, positions, servos, tasks, alarms'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "clock" -d 'The controller\'s clock'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "alarm" -d 'Alarms'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "io" -d 'Signals: what the controller shows and is shown'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "power-on" -d 'Servos on, by signals'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "emergency-stop" -d 'Into emergency stop, by signals'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "recover" -d 'Out of emergency stop with servos on, by signals'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "auto-mode" -d 'Wait for AUTO mode'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "reset" -d 'Reset the robot program, by signals'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "run" -d 'Run the robot program, by signals'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "stop" -d 'Stop the robot program, by signals'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "status-reset" -d 'Reset the status of remote commands'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "raw" -d 'Send the words of any remote command, and explain the answer'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and not __fish_seen_subcommand_from status move movei movet drive drivei pallet push jog inch inch-distance teach origin abs-reset speed shift hand arm torque-limit servo motor point comment pallet-data shift-data hand-data point-calc var param port program info clock alarm io power-on emergency-stop recover auto-mode reset run stop status-reset raw eip" -f -a "eip" -d 'The network board itself: who it is, which assemblies it has (diagnosis)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -l full -d 'Take command of the controller, and ask for servos and position as well'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l point -d 'Point to move to; two points of an arc with --circular, as in 100,101' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l to -d 'Coordinates of the axes in mm, of all four or of those of --axes' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l to-pulse -d 'Coordinates of the axes in pulses, likewise' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l arch -d 'In an arch: this axis goes to this position first, as in 3:10.0' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l arch-start -d 'Where the arch begins; 0 unless given' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l arch-end -d 'Where the arch ends; 0 unless given' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l arch-unit -d 'What positions of the arch are measured in' -r -f -a "mm\t'Millimetres; degrees of what turns'
pulse\t'Pulses of the encoders'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l axes -d 'Axes that move, as in 1,3; all unless given' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l speed -d 'Percent, as in 50 or 50%, in place of the program speed' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l speed-of-max -d 'Percent of the robot\'s maximum, in steps of 0.01' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l accel -d 'Acceleration in percent' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l decel -d 'Deceleration in percent' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l hand -d 'Hand system of the coordinates of --to' -r -f -a "right\t'Right-handed'
left\t'Left-handed'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l report -d 'Report the position at the end, in this unit' -r -f -a "mm\t'Millimetres; degrees of what turns'
pulse\t'Pulses of the encoders'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l linear -d 'In a straight line; --speed may be 200mm/s then'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l circular -d 'In an arc over the first point to the second; --speed may be 200mm/s then'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l no-wait -d 'Do not wait for the end'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from move" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l point -d 'Point whose data are the distances' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l by -d 'Distances of the axes in mm, of all four or of those of --axes' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l by-pulse -d 'Distances of the axes in pulses, likewise' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l axes -d 'Axes that move, as in 1,3; all unless given' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l speed -d 'Percent, as in 50 or 50%, in place of the program speed' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l speed-of-max -d 'Percent of the robot\'s maximum, in steps of 0.01' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l accel -d 'Acceleration in percent' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l decel -d 'Deceleration in percent' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l hand -d 'Hand system at the end of --by' -r -f -a "right\t'Right-handed'
left\t'Left-handed'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l report -d 'Report the position at the end, in this unit' -r -f -a "mm\t'Millimetres; degrees of what turns'
pulse\t'Pulses of the encoders'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l linear -d 'In a straight line; --speed may be 200mm/s then'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l no-wait -d 'Do not wait for the end'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movei" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l point -d 'Point to move to' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l axes -d 'Axes that move, as in 1,3; all unless given' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l speed -d 'Percent, as in 50 or 50%, in place of the program speed' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l speed-of-max -d 'Percent of the robot\'s maximum, in steps of 0.01' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l accel -d 'Acceleration in percent' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l decel -d 'Deceleration in percent' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l report -d 'Report the position at the end, in this unit' -r -f -a "mm\t'Millimetres; degrees of what turns'
pulse\t'Pulses of the encoders'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l linear -d 'In a straight line; --speed may be 200mm/s then'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l no-wait -d 'Do not wait for the end'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from movet" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l axis -d 'Axis to move, 1 to 4' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l point -d 'Point whose coordinate of this axis is the target' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l to -d 'Position in mm, of an axis that turns in degrees' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l to-pulse -d 'Position in pulses' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l speed -d 'Percent, as in 50 or 50%, in place of the program speed' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l speed-of-max -d 'Percent of the robot\'s maximum, in steps of 0.01' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l report -d 'Report the position at the end, in this unit' -r -f -a "mm\t'Millimetres; degrees of what turns'
pulse\t'Pulses of the encoders'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l no-wait -d 'Do not wait for the end'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drive" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l axis -d 'Axis to move, 1 to 4' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l point -d 'Point whose coordinate of this axis is the distance' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l by -d 'Distance in mm, of an axis that turns in degrees' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l by-pulse -d 'Distance in pulses' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l speed -d 'Percent, as in 50 or 50%, in place of the program speed' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l speed-of-max -d 'Percent of the robot\'s maximum, in steps of 0.01' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l report -d 'Report the position at the end, in this unit' -r -f -a "mm\t'Millimetres; degrees of what turns'
pulse\t'Pulses of the encoders'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l no-wait -d 'Do not wait for the end'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from drivei" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l pallet -d 'Pallet, 0 to 39' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l position -d 'Place on it, from 1 on' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l arch -d 'In an arch: this axis goes to this position first, as in 3:10.0' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l arch-start -d 'Where the arch begins; 0 unless given' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l arch-end -d 'Where the arch ends; 0 unless given' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l arch-unit -d 'What positions of the arch are measured in' -r -f -a "mm\t'Millimetres; degrees of what turns'
pulse\t'Pulses of the encoders'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l speed -d 'Percent, as in 50 or 50%, in place of the program speed' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l speed-of-max -d 'Percent of the robot\'s maximum, in steps of 0.01' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l accel -d 'Acceleration in percent' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l decel -d 'Deceleration in percent' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l report -d 'Report the position at the end, in this unit' -r -f -a "mm\t'Millimetres; degrees of what turns'
pulse\t'Pulses of the encoders'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l no-wait -d 'Do not wait for the end'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l axis -d 'Axis to push with, 1 to 4' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l point -d 'Point whose coordinate of this axis is the target' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l to -d 'Position in mm, of an axis that turns in degrees' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l to-pulse -d 'Position in pulses' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l force -d 'Force in percent of the rated torque, -1000 to 1000' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l time -d 'How long to push, 1ms to 32767ms' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l speed -d 'Percent, as in 50 or 50%, in place of the program speed' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l speed-of-max -d 'Percent of the robot\'s maximum, in steps of 0.01' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l report -d 'Report the position at the end, in this unit' -r -f -a "mm\t'Millimetres; degrees of what turns'
pulse\t'Pulses of the encoders'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l no-wait -d 'Do not wait for the end'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from push" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -l for -d 'How long; until Ctrl-C unless given' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -l report -d 'Report the position at the end, in this unit; in that of the axes unless given' -r -f -a "mm\t'Millimetres; degrees of what turns'
pulse\t'Pulses of the encoders'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from jog" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -l report -d 'Report the position at the end, in this unit' -r -f -a "mm\t'Millimetres; degrees of what turns'
pulse\t'Pulses of the encoders'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -l no-wait -d 'Do not wait for the end'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from inch-distance" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -l point -d 'Point to store it in, 0 to 29999' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -l in -d 'Unit of the point' -r -f -a "mm\t'Millimetres; degrees of what turns'
pulse\t'Pulses of the encoders'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from teach" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -l axis -d 'One axis of one robot, 1 to 4' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -l only -d 'Only axes of this kind' -r -f -a "incremental\t'Axes of the incremental type'
absolute\t'Axes of the absolute type'
incomplete\t'Axes whose origin is not known'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -l no-wait -d 'Do not wait for the end'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from origin" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -l axis -d 'The axis, 1 to 4' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -l move -d 'Move only, this way, to the nearest position where a reset is possible' -r -f -a "+\t'Plus'
-\t'Minus'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -l no-wait -d 'Do not wait for the end of the motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from abs-reset" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from speed" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift" -f -a "select" -d 'Select a shift of the coordinates'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand" -f -a "select" -d 'Select the hand at the robot\'s end'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from arm" -f -a "select" -d 'Select the hand system that coordinates are reached in'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -l axis -d 'The axis, 1 to 4' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from torque-limit" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -l axis -d 'Only this axis, 1 to 4' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from servo" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from motor" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -f -a "get" -d 'Read points: 100, 0..29'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point" -f -a "set" -d 'Define a point: 100 --mm 10,-20,5,-18'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -f -a "get" -d 'Read the comments of points: 100, 0..29'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from comment" -f -a "set" -d 'Write the comment of a point: 100 \'WAIT ORG\''
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -f -a "get" -d 'Read pallets: 10, 0..39'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from pallet-data" -f -a "set" -d 'Define a pallet: 10 --nx 10 --ny 15 --first-point 100'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -f -a "get" -d 'Read shifts: 5, 0..39'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from shift-data" -f -a "set" -d 'Define a shift: 5 --mm 10,-20,5,-18'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -f -a "get" -d 'Read hands: 1, 0..31'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from hand-data" -f -a "set" -d 'Define a hand: 1 --data-1 10000 --data-2 -2 --data-3 5'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -f -a "copy" -d 'Copy a point: 100 --to 1'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -f -a "add" -d 'Add a point to another one: 100 --to 1'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -f -a "sub" -d 'Subtract a point from another one: 100 --from 1'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -f -a "pallet" -d 'Copy a place of a pallet to a point: 2 --place 133 --to 100'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -f -a "element" -d 'Set one element of a point: 1 --element 4 --mm 1.0'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from point-calc" -f -a "shift-element" -d 'Set one element of a shift: 1 --element 2 --mm 1.0'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -f -a "get" -d 'Read variables: SGI1, SGI0..SGI31, SGR5'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -f -a "set" -d 'Set a variable: SGI1 10000, or SGI1 SGI2'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -f -a "add" -d 'Add a number or a variable to a variable'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -f -a "sub" -d 'Subtract a number or a variable from a variable'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -f -a "mul" -d 'Multiply a variable by a number or a variable'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from var" -f -a "div" -d 'Divide a variable by a number or a variable'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -f -a "get" -d 'Read parameters: WEIGHT, or TOLE --axis 1,3'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from param" -f -a "set" -d 'Set a parameter: TOLE 1000 --axis 3'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -f -a "get" -d 'Read ports or signals: DI2, DO12, DO2.1'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from port" -f -a "set" -d 'Switch a port or a signal: DO12 7, DO2.1 on'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -f -a "select" -d 'Register a program in a task'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -f -a "run" -d 'Run a program, or all of them'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -f -a "step" -d 'Run one line, also of a subroutine'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -f -a "skip" -d 'Skip one line'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -f -a "next" -d 'Run one line, a subroutine as a whole'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -f -a "reset" -d 'Put a program back to its first line, or all of them'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from program" -f -a "show" -d 'Read what a program does'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -f -a "version" -d 'Versions of the software'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -f -a "system" -d 'Model numbers of a robot and its axes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -f -a "position" -d 'Where a robot is, once or as it changes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -f -a "servo" -d 'The servo of each axis'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -f -a "origin" -d 'Whether the origin is known'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -f -a "arm" -d 'Hand systems: the selected one and the arm\'s'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -f -a "speed" -d 'Speed settings'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -f -a "torque" -d 'Torque of the axes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -f -a "inch" -d 'The inching amount'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -f -a "tasks" -d 'What tasks do'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -f -a "line" -d 'Which line each task stands at'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -f -a "slots" -d 'What is in the option slots'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -f -a "message" -d 'Messages of the alarm history'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from info" -f -a "alarm" -d 'An alarm of the history, or the latest of a remote command'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -f -a "get" -d 'Read date and time'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from clock" -f -a "set" -d 'Set date and time: now, 2026-03-01T08:45:00, 2026-03-01 or 08:45'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from alarm" -f -a "reset" -d 'Reset the alarm'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -f -a "get" -d 'Read signals'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -f -a "set" -d 'Switch inputs of the controller: servo-on=on, 20=off'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -f -a "pulse" -d 'Switch an input of the controller on and off again'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -f -a "watch" -d 'Tell each change of signals until Ctrl-C'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from io" -f -a "map" -d 'The addresses of words and signals on a fieldbus, for the PLC engineer'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from power-on" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from emergency-stop" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from recover" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from auto-mode" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from reset" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from run" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from stop" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from status-reset" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -l wi -d 'WI0 to WI15, as in 0x0001,0x0004,0,0x0032,0x0013' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from raw" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -l unit -d 'Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -f -a "identity" -d 'Who the board is'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -f -a "probe" -d 'Find the assemblies of the board, their sizes, and what makes a connection'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -f -a "get" -d 'Read an attribute of an object of the board (raw)'
complete -c armctl -n "__fish_armctl_using_subcommand yrcx; and __fish_seen_subcommand_from eip" -f -a "set" -d 'Change an attribute of an object of the board (raw)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "status" -d 'All five status pages in words'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "home" -d 'Return to the origin'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "position" -d 'Where the axes are'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "host" -d 'Take or give back the command of the controller'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "mode" -d 'Choose how programs run, or which kind of them'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "servo" -d 'Switch servo power'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "stop" -d 'Stop what runs, or what is jogged'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "reset" -d 'Put programs back to their beginning'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "error" -d 'Errors'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "run" -d 'Run programs, and move to a point'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "jog" -d 'Move one axis, for a time or by small steps'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "param" -d 'Parameters: read, change, save, restore'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "point" -d 'Points of the coordinate table'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "speed-table" -d 'Speeds that programs name by their row'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "accel-table" -d 'Acceleration times that programs name by their row'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "mvm" -d 'Groups of the MVM table, from which MVM moves along a matrix'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "torque-table" -d 'Torque limits that programs name by their row'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "program" -d 'Sequential programs: read, write, edit, check'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "palletizing" -d 'Palletizing programs'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "easy" -d 'Easy programs'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "backup" -d 'Save all that is stored in the controller in a folder'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "restore" -d 'Write back what a backup holds'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "io" -d 'Input, output and internal ports'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "counter" -d 'Counters'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "timer" -d 'Timers'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "override" -d 'The share of their speeds that programs run at'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "task" -d 'The task that programs and points are those of'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "offset" -d 'How far coordinates are shifted at present'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "coordinate" -d 'Supply coordinates to a program'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "bus" -d 'Settings and errors of CC-Link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "card" -d 'The memory card'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "init" -d 'Clear memory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "robot-type" -d 'Set the robot type of an axis'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "info" -d 'Robot type, versions, axes, task, override'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "raw" -d 'Send any block, and explain the answer'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "ports" -d 'The serial ports of this machine'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and not __fish_seen_subcommand_from status home position host mode servo stop reset error run jog param point speed-table accel-table mvm torque-table program palletizing easy backup restore io counter timer override task offset coordinate bus card init robot-type info raw ports sim" -f -a "sim" -d 'Programs at the desk, without any controller'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from status" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from status" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from status" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from status" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from status" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from status" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from status" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from status" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from status" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from status" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from status" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from status" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from status" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from status" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from status" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from status" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from status" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from status" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from status" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from status" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from status" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from status" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from status" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from status" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from status" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -l sync -d 'Search the origin of synchronized axes instead, with this drive axis, 1 to 3 (KCA-20-M00 and -M01)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -l no-wait -d 'Return as soon as the controller has accepted it'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from home" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from position" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from position" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from position" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from position" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from position" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from position" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from position" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from position" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from position" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from position" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from position" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from position" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from position" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from position" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from position" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from position" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from position" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from position" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from position" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from position" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from position" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from position" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from position" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from position" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from position" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from host" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from host" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from host" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from host" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from host" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from host" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from host" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from host" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from host" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from host" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from host" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from host" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from host" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from host" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from host" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from host" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from host" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from host" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from host" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from host" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from host" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from host" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from host" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from host" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from host" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mode" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mode" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mode" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mode" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mode" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mode" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mode" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mode" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mode" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mode" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mode" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mode" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mode" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mode" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mode" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mode" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mode" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mode" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mode" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mode" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mode" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mode" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mode" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mode" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mode" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from servo" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from servo" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from servo" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from servo" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from servo" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from servo" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from servo" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from servo" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from servo" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from servo" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from servo" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from servo" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from servo" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from servo" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from servo" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from servo" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from servo" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from servo" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from servo" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from servo" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from servo" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from servo" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from servo" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from servo" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from servo" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -l jog -d 'Stop a JOG, as after an armctl that was killed while an axis was jogged'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from stop" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from reset" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from reset" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from reset" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from reset" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from reset" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from reset" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from reset" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from reset" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from reset" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from reset" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from reset" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from reset" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from reset" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from reset" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from reset" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from reset" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from reset" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from reset" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from reset" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from reset" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from reset" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from reset" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from reset" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from reset" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from reset" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -f -a "show" -d 'The error that is present, with cause and remedy'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -f -a "history" -d 'The errors of the past, the latest first'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -f -a "cancel" -d 'Cancel the error'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from error" -f -a "point" -d 'The point at which the error came up'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -f -a "sequential" -d 'Start the sequential program'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -f -a "palletizing" -d 'Start palletizing'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -f -a "easy" -d 'Start the easy program'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from run" -f -a "point" -d 'Move to a row of the coordinate table'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -l for -d 'How long it moves, 100ms to 60s (low and high)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -l steps -d 'How many small steps, one after the other (inch)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from jog" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -f -a "get" -d 'Read parameters by name or id: soft-limit-plus P01 M09'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -f -a "set" -d 'Change a parameter: soft-limit-plus 100 200 0 0'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -f -a "list" -d 'Read all parameters'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -f -a "dump" -d 'Save all parameters and tables as TOML'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from param" -f -a "restore" -d 'Write back what a file of parameters holds'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -f -a "get" -d 'Read points: 1-10,20'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -f -a "set" -d 'Write a point, or all that a CSV file has'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from point" -f -a "list" -d 'Read all points, also into a CSV file'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -f -a "get" -d 'Read rows: 1-5,20; without any, all 20'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from speed-table" -f -a "set" -d 'Write a row: 5 250'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -f -a "get" -d 'Read rows: 1-5,20; without any, all 20'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from accel-table" -f -a "set" -d 'Write a row: 5 0.25'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -f -a "get" -d 'Read groups: 1-3; without any, all 32'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from mvm" -f -a "set" -d 'Change values of a group: 1 origin=5 pieces1=10'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -f -a "get" -d 'Read rows: 1-3; without any, all 8'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from torque-table" -f -a "set" -d 'Write a row: 3 2.5 2.0'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -f -a "list" -d 'The tasks, with the steps their programs have room for and use'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -f -a "get" -d 'Read a program as text'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -f -a "put" -d 'Write a program from a file, after checking it whole'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -f -a "insert" -d 'Insert a step; those behind it move on'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -f -a "delete" -d 'Delete steps; those behind them move up'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -f -a "copy" -d 'Copy steps, also between tasks'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -f -a "search" -d 'Find the step of a tag'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -f -a "show" -d 'The step at which the program stands'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from program" -f -a "check" -d 'Check program files; takes no robot'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -f -a "get" -d 'Read the records of a program, also into a TOML file'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -f -a "set" -d 'Write a record, or those of a TOML file: 1 source-p1 x=100'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -f -a "copy" -d 'Copy a program to another place'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -f -a "select" -d 'Choose the program that run palletizing starts'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from palletizing" -f -a "progress" -d 'How far the program is that runs'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -f -a "get" -d 'Read programs: 1-3; without any, all 8'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -f -a "set" -d 'Write a program: 1 START LOOP END'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -f -a "copy" -d 'Copy a program to another place'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -f -a "select" -d 'Choose the program that run easy starts'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from easy" -f -a "progress" -d 'How far the program is that runs'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -l current-task -d 'Points and program of the current task only, so that nothing is changed'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -l resume -d 'Go on with a backup that is not whole; parts that are there already are kept'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -l force -d 'Make a new backup over the one in the folder'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from backup" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -l only -d 'These parts only, such as parameters,points-1,program' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -l resume -d 'Go on with a restore that was cut off; with a part, those before it are not even compared' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -l machine -d 'Write machine and special parameters, too; needs --yes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -l force -d 'Write the backup of one robot type to another'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from restore" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -f -a "in" -d 'Input ports'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -f -a "out" -d 'Output ports'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -f -a "internal" -d 'Internal ports'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -f -a "set" -d 'Set outputs: 1.3=on, or 1=.......1 for the bits of a whole port'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from io" -f -a "direct" -d 'Order one of the direct outputs F1 to F4'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -f -a "get" -d 'Read counters 1 to 99'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from counter" -f -a "set" -d 'Set a counter'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from timer" -f -a "get" -d 'Read timers 1 to 9'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -f -a "get" -d 'Read the override'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from override" -f -a "set" -d 'Write the override to the EEPROM; it counts while no program runs'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -f -a "get" -d 'Which task is the current one'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from task" -f -a "set" -d 'Choose the task whose program and points are read, written and cleared'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from offset" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from offset" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from offset" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from offset" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from offset" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from offset" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from offset" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from offset" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from offset" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from offset" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from offset" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from offset" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from offset" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from offset" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from offset" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from offset" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from offset" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from offset" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from offset" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from offset" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from offset" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from offset" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from offset" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from offset" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from offset" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from coordinate" -f -a "set" -d 'Supply coordinates to an RSMV, which moves there'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from bus" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from bus" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from bus" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from bus" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from bus" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from bus" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from bus" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from bus" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from bus" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from bus" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from bus" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from bus" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from bus" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from bus" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from bus" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from bus" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from bus" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from bus" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from bus" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from bus" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from bus" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from bus" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from bus" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from bus" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from bus" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -f -a "read" -d 'Read everything from the card, over what the controller holds'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from card" -f -a "write" -d 'Write everything that the controller holds to the card'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from init" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from init" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from init" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from init" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from init" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from init" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from init" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from init" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from init" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from init" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from init" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from init" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from init" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from init" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from init" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from init" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from init" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from init" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from init" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from init" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from init" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from init" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from init" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from init" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from init" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from robot-type" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from robot-type" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from robot-type" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from robot-type" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from robot-type" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from robot-type" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from robot-type" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from robot-type" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from robot-type" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from robot-type" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from robot-type" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from robot-type" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from robot-type" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from robot-type" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from robot-type" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from robot-type" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from robot-type" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from robot-type" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from robot-type" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from robot-type" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from robot-type" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from robot-type" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from robot-type" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from robot-type" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from robot-type" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from info" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from info" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from info" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from info" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from info" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from info" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from info" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from info" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from info" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from info" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from info" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from info" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from info" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from info" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from info" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from info" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from info" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from info" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from info" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from info" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from info" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from info" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from info" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from info" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from info" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from raw" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from raw" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from raw" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from raw" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from raw" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from raw" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from raw" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from raw" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from raw" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from raw" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from raw" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from raw" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from raw" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from raw" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from raw" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from raw" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from raw" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from raw" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from raw" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from raw" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from raw" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from raw" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from raw" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from raw" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from raw" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from ports" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from ports" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from ports" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from ports" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from ports" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from ports" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from ports" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from ports" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from ports" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from ports" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from ports" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from ports" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from ports" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from ports" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from ports" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from ports" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from ports" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from ports" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from ports" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from ports" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from ports" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from ports" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from ports" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from ports" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from ports" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand toyo; and __fish_seen_subcommand_from sim" -f -a "run" -d 'Run a program file and print what happens and when; takes no robot'
complete -c armctl -n "__fish_armctl_using_subcommand status" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand status" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand status" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand status" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand status" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand status" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand status" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand status" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand status" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand status" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand status" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand status" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand status" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand status" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand status" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand status" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand status" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand status" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand status" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand status" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand status" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand status" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand status" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand status" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand status" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -f -a "list" -d 'Every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -f -a "show" -d 'One robot with every setting in force'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -f -a "add" -d 'Add a robot'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -f -a "remove" -d 'Remove a robot'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -f -a "check" -d 'What is wrong between this machine and a robot, and what to set'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and not __fish_seen_subcommand_from list show add remove check discover" -f -a "discover" -d 'Which EtherNet/IP boards answer on the network, and which serial ports are there'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from list" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from list" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from list" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from list" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from list" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from list" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from list" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from list" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from list" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from list" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from list" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from list" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from list" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from list" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from list" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from list" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from list" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from list" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from list" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from list" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from list" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from list" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from list" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from list" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from list" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -l origin -d 'Say where each value came from'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from show" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -l family -d 'Its family, where the URL does not tell' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -l with-tag -d 'A word to choose it by (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -l read-only -d 'Take read commands only'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -l default -d 'Make it the robot that is taken when none is named'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from add" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from remove" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from remove" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from remove" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from remove" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from remove" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from remove" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from remove" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from remove" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from remove" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from remove" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from remove" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from remove" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from remove" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from remove" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from remove" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from remove" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from remove" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from remove" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from remove" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from remove" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from remove" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from remove" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from remove" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from remove" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from remove" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from check" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from check" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from check" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from check" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from check" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from check" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from check" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from check" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from check" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from check" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from check" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from check" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from check" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from check" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from check" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from check" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from check" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from check" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from check" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from check" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from check" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from check" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from check" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from check" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from check" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -l broadcast -d 'Ask everybody at this broadcast address, 255.255.255.255 unless given (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -l bind -d 'Ask from this address of this machine' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -l wait -d 'How long to wait for answers' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand robots; and __fish_seen_subcommand_from discover" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -f -a "open" -d 'Hold the link to a robot, for all commands that follow'
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -f -a "list" -d 'Which links are held, and who uses them'
complete -c armctl -n "__fish_armctl_using_subcommand session; and not __fish_seen_subcommand_from open list close" -f -a "close" -d 'Let the link to a robot go'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -l family -d 'The family, where the target does not tell' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -l background -d 'Go on behind the terminal; return once the link is up'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -l detached -d 'This is the process that `--background` has started'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from open" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from list" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from list" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from list" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from list" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from list" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from list" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from list" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from list" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from list" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from list" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from list" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from list" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from list" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from list" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from list" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from list" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from list" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from list" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from list" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from list" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from list" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from list" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from list" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from list" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from list" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -l force -d 'Although a motion is under way, which a controller then breaks off'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand session; and __fish_seen_subcommand_from close" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -f -a "yerc" -d 'An FS100 or DX200 on two UDP ports'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -f -a "yrcx" -d 'A YRCX as an adapter of EtherNet/IP'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and not __fish_seen_subcommand_from yerc yrcx toyo" -f -a "toyo" -d 'A Toyo controller on a TCP port, like a serial device server, or on a pseudo-terminal'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -l bind -d 'Address to listen on, with the port of the robot server; port 0 lets the system choose' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -l file-port -d 'Port of the file server; one above the robot server\'s unless given' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -l model -d 'Controller model, fs100 or dx200' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -l state -d 'Start state (TOML): modes, variables, jobs, files, alarms, timed events' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -l fault -d 'Faults on the line, such as drop=5%,dup=2%,delay=0..50ms,reorder=3%,corrupt=1%,busy=4%,seed=7' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -l console -d 'Take lines on stdin: `alarm 4315`, `mode teach`, `io 20010 on`, `help`'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yerc" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -l bind -d 'Address to listen on, with the TCP port of sessions; port 0 lets the system choose' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -l io-port -d 'UDP port of images, 2222 unless given; any where the system chooses that of sessions' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -l state -d 'Start state (TOML): robots, memory, programs, alarms, timed events' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -l fault -d 'Faults of images on their way, such as drop=5%,dup=2%,delay=0..50ms,reorder=3%,corrupt=1%,seed=7' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -l mischief -d 'What the adapter does wrong: drop, stall, stale, double, wrong-sequence, wrong-id, wrong-size, frozen, unreadable, reset, mute, garbage' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -l console -d 'Take lines on stdin; `help` lists them'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from yrcx" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l bind -d 'Address to listen on, with the TCP port; port 0 lets the system choose' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l link -d 'Name the pseudo-terminal by a symbolic link, which is removed at the end' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l axes -d 'Axes of the robot' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l baud -d 'Let characters take as long as on a line of so many bits a second, such as 9600; at once unless given' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l state -d 'Start state (TOML): modes, memory, inputs, errors, timed events' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l fault -d 'Faults on the line, such as noise=1%,parity=1%,drop=1%,dup=1%,delay=0..50ms,busy=4%,echo,seed=7' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l pty -d 'Serve on a pseudo-terminal instead, whose path is printed (not on Windows)'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l console -d 'Take lines on stdin; `help` lists them'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand sim; and __fish_seen_subcommand_from toyo" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -f -a "yerc" -d 'Frames of the high-speed Ethernet server, as from a packet capture'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -f -a "yrcx" -d 'Words of remote commands and their answers'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and not __fish_seen_subcommand_from yerc yrcx toyo" -f -a "toyo" -d 'Lines of the host communication, of either side'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -l command -d 'Command whose answer it is, such as 0x75' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -l instance -d 'Instance that was asked for' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -l attribute -d 'Attribute that was asked for' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -l frame -d 'Show the messages of one packet, field by field' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -l host -d 'Only what comes from or goes to this address' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -l port -d 'Only what comes from or goes to this port' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yerc" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -l wi -d 'WI0 to WI15, as in 0x0001,0x0004,0,0x0032,0x0013' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -l wo -d 'WO0 to WO15, as in 0x4000,0x0002,0x014E' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -l frame -d 'Show the messages of one packet, field by field' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -l host -d 'Only what comes from or goes to this address' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -l port -d 'Only what comes from or goes to this port' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -l every-image -d 'Images that say nothing new, too'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from yrcx" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -l frame -d 'Show the messages of one packet, field by field' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -l host -d 'Only what comes from or goes to this address' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -l port -d 'Only what comes from or goes to this port' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand decode; and __fish_seen_subcommand_from toyo" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -f -a "yerc" -d 'A status code (one byte) or added status code (two bytes) of an FS100 or DX200'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -f -a "yrcx" -d 'An alarm of a YRCX'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and not __fish_seen_subcommand_from yerc yrcx toyo" -f -a "toyo" -d 'An error code of a Toyo controller'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yerc" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yerc" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yerc" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yerc" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yerc" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yerc" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yerc" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yerc" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yerc" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yerc" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yerc" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yerc" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yerc" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yerc" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yerc" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yerc" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yerc" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yerc" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yerc" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yerc" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yerc" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yerc" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yerc" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yerc" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yerc" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yrcx" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yrcx" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yrcx" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yrcx" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yrcx" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yrcx" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yrcx" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yrcx" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yrcx" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yrcx" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yrcx" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yrcx" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yrcx" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yrcx" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yrcx" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yrcx" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yrcx" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yrcx" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yrcx" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yrcx" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yrcx" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yrcx" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yrcx" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yrcx" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from yrcx" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from toyo" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from toyo" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from toyo" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from toyo" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from toyo" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from toyo" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from toyo" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from toyo" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from toyo" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from toyo" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from toyo" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from toyo" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from toyo" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from toyo" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from toyo" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from toyo" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from toyo" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from toyo" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from toyo" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from toyo" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from toyo" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from toyo" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from toyo" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from toyo" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand explain; and __fish_seen_subcommand_from toyo" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand completions" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand completions" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand completions" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand completions" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand completions" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand completions" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand completions" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand completions" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand completions" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand completions" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand completions" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand completions" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand completions" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand completions" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand completions" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand completions" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand completions" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand completions" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand completions" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand completions" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand completions" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand completions" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand completions" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand completions" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand completions" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand man" -l dir -d 'The folder, such as /usr/local/share/man/man1; it must exist' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand man" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand man" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand man" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand man" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand man" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand man" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand man" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand man" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand man" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand man" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand man" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand man" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand man" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand man" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand man" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand man" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand man" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand man" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand man" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand man" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand man" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand man" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand man" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand man" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand man" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand schema" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand schema" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand schema" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand schema" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand schema" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand schema" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand schema" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand schema" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand schema" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand schema" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand schema" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand schema" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand schema" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand schema" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand schema" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand schema" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand schema" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand schema" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand schema" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand schema" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand schema" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand schema" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand schema" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand schema" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand schema" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c armctl -n "__fish_armctl_using_subcommand help" -s t -l target -d 'Talk to the controller at URL, such as udp://192.168.1.31 or serial:///dev/ttyUSB0 (ARMCTL_TARGET)' -r
complete -c armctl -n "__fish_armctl_using_subcommand help" -s r -l robot -d 'Talk to a robot of the inventory, by name or pattern (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand help" -l tag -d 'Talk to the robots of the inventory with this tag (repeatable)' -r
complete -c armctl -n "__fish_armctl_using_subcommand help" -l config -d 'The inventory, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand help" -s o -l format -d 'How to print data' -r -f -a "table\t'Tables for people'
json\t'One envelope, or an array of them'
jsonl\t'An envelope a line, with the time'
csv\t'Comma-separated values'"
complete -c armctl -n "__fish_armctl_using_subcommand help" -l jq -d 'Print what a jq filter makes of the JSON' -r
complete -c armctl -n "__fish_armctl_using_subcommand help" -l color -d 'Colour' -r -f -a "auto\t'On a terminal that can, unless `NO_COLOR` is set'
always\t'Even into a file'
never\t'Not at all'"
complete -c armctl -n "__fish_armctl_using_subcommand help" -l trace -d 'Record the traffic: a .pcapng file for Wireshark, or - for text on stderr' -r -F
complete -c armctl -n "__fish_armctl_using_subcommand help" -l on-interrupt -d 'What Ctrl-C does to a motion' -r -f -a "stop\t'Stop the robot, then disconnect'
leave\t'Disconnect only; the motion goes on'"
complete -c armctl -n "__fish_armctl_using_subcommand help" -l timeout -d 'Longest wait for an answer (ARMCTL_TIMEOUT)' -r
complete -c armctl -n "__fish_armctl_using_subcommand help" -l retries -d 'Repetitions of a read after silence (changes are never repeated; ARMCTL_RETRIES)' -r
complete -c armctl -n "__fish_armctl_using_subcommand help" -l encoding -d 'Encoding of names and texts on the controller (ARMCTL_ENCODING)' -r
complete -c armctl -n "__fish_armctl_using_subcommand help" -l watch -d 'Repeat a read, every second or every INTERVAL' -r
complete -c armctl -n "__fish_armctl_using_subcommand help" -l count -d 'Stop after so many reads' -r
complete -c armctl -n "__fish_armctl_using_subcommand help" -l until -d 'Repeat a read until a jq filter over its JSON is true' -r
complete -c armctl -n "__fish_armctl_using_subcommand help" -l for -d 'How long --until waits before it gives up with exit code 8' -r
complete -c armctl -n "__fish_armctl_using_subcommand help" -l sim -d 'Talk to the built-in simulator, in this process'
complete -c armctl -n "__fish_armctl_using_subcommand help" -l all -d 'Talk to every robot of the inventory'
complete -c armctl -n "__fish_armctl_using_subcommand help" -l json -d 'Print JSON (the same as -o json)'
complete -c armctl -n "__fish_armctl_using_subcommand help" -s q -l quiet -d 'Only errors and questions on stderr'
complete -c armctl -n "__fish_armctl_using_subcommand help" -s v -l verbose -d 'Say more on stderr: -v a summary, -vv frames, -vvv bytes'
complete -c armctl -n "__fish_armctl_using_subcommand help" -s y -l yes -d 'Answer yes to the question before a motion'
complete -c armctl -n "__fish_armctl_using_subcommand help" -l dry-run -d 'Send nothing; print what would be sent'
complete -c armctl -n "__fish_armctl_using_subcommand help" -l no-session -d 'Go to the robot directly, although a session holds its link'
complete -c armctl -n "__fish_armctl_using_subcommand help" -s h -l help -d 'Print help (see more with \'--help\')'
