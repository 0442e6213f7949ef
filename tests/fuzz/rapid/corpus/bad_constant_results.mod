MODULE M
  VAR num n;
  PROC main()
    n:=1/0;
    n:=Sqrt(-1);
    n:=7 DIV 2.5;
    n:=5 MOD 0;
    WaitTime -1;
    WaitDI di1,1\MaxTime:=1E9;
    FOR i FROM 1 TO 3 STEP 0 DO
    ENDFOR
  ENDPROC
ENDMODULE
