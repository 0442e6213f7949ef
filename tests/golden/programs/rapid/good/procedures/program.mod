MODULE M
  VAR num n:=0;
  PROC open()
    Reset do1;
  ENDPROC
  PROC main()
    OPEN;
    close_it;
    twice;
    WaitTime n;
  ENDPROC
  PROC close_it()
    Set do1;
    RETURN;
    Set do2;
  ENDPROC
  LOCAL PROC twice()
    Close_It;
    n:=n+1;
    close_it;
  ENDPROC
ENDMODULE
