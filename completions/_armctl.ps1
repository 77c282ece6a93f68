# Completion of armctl for PowerShell. The program itself is asked what could stand at the cursor, so this file does not
# age.
Register-ArgumentCompleter -Native -CommandName armctl, yerc, yrcx, toyo -ScriptBlock {
    param($wordToComplete, $commandAst, $cursorPosition)

    $before = @($commandAst.CommandElements | Where-Object { $_.Extent.EndOffset -lt $cursorPosition } | ForEach-Object {
        if ($null -ne $_.Value) { "$($_.Value)" } else { $_.Extent.Text }
    })
    $previous = $env:ARMCTL_COMPLETE
    try {
        $env:ARMCTL_COMPLETE = 'powershell'
        # An empty argument would get lost on the way: the word at the cursor has a mark in front.
        $answer = & armctl '--' $before "+$wordToComplete" 2>$null
    } finally {
        $env:ARMCTL_COMPLETE = $previous
    }
    $answer | Where-Object { $_ } | ForEach-Object {
        $value, $help = $_ -split "`t", 2
        if (-not $help) { $help = $value }
        $text = if ($value -match '[\s''"`$&|;<>(){}@#,]') { "'" + ($value -replace "'", "''") + "'" } else { $value }
        [System.Management.Automation.CompletionResult]::new($text, $value, 'ParameterValue', $help)
    }
}
