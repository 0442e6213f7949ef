MODULE M
  VAR num n
  PROC main()
    Set do1
    Reset do9x;
    WaitTime 1 2;
    n:=1
    n:=;
    Set do2
  ENDPROC
ENDMODULE
