MODULE M
  RECORD part
    num x;
  ENDRECORD
  FUNC num twice(num x)
    RETURN 2*x;
  ENDFUNC
  TRAP alarm
    Stop;
  ENDTRAP
  PROC main()
    WaitTime twice(2);
    RETURN 1;
  ENDPROC
ENDMODULE
