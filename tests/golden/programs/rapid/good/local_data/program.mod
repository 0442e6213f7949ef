MODULE M
  VAR num n:=5;
  PROC main()
    count;
    count;
    WaitTime n;
    FOR n FROM 1 TO 2 DO
      WaitTime n;
    ENDFOR
    WaitTime n;
  ENDPROC
  PROC count()
    VAR num n:=1;
    CONST num more:=2;
    VAR bool b;
    n:=n+more;
    IF NOT b WaitTime n;
    b:=TRUE;
  ENDPROC
ENDMODULE
